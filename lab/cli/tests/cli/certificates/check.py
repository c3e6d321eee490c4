"""Checks certificates (schema bowden.certificate/1, one a line on stdin) with exact fractions.

Written from the theorem (theorems/Box.v) and the lines of the step, not from the program. Both
sides of each inequality are computed anew at the certificate's own S and Z: a side that is
stated too favourably, or further off than outward rounding makes it, is told, as is a
certificate that says `proved` where an inequality does not hold. Exit status 1 if any is.
"""
import json, sys
from fractions import Fraction as F

BITS = {"f32": (24, 149), "f64": (53, 1074)}


def number(text):
    mantissa, exponent = text.split("*2^")
    return F(int(mantissa)) * F(2) ** int(exponent)


def sides(c):
    bits, least = BITS[c["float"]]
    u, eta = F(1, 2 ** bits), F(1, 2 ** (least + 1))
    of = lambda tree: {k: [number(x) for x in v] if isinstance(v, list) else v and number(v) for k, v in tree.items()}
    gains, plant, regressors = of(c["gains"]), of(c["plant"]), [of(r) for r in c["regressors"]]
    S, Z, r = number(c["s"]["exact"]), number(c["z"]["exact"]), plant["reference"]
    k, lam, h = gains["k"], gains["lambda"], gains["step"]
    delta, beta = gains["delta"][1], gains["beta"]
    g = [plant["alpha"][i] * beta[i] for i in (0, 1)]
    # What acts on the errors.
    W = max(abs(1 - g[0]), abs(g[1] - 1)) * (r + plant["reference_rate"] / lam) + plant["disturbance"]
    xi, load, comp = plant["disturbance_rate"], plant["disturbance"], (F(0), F(0))
    # (bound of the exact value, bound of the error); additions that underflow are exact.
    add = lambda a, b: (a[0] + b[0], a[1] + b[1] + u * (a[0] + b[0] + a[1] + b[1]))
    rnd = lambda m, e: (m, e + u * (m + e) + eta)
    mul = lambda a, b: rnd(a[0] * b[0], a[0] * b[1] + b[0] * a[1] + a[1] * b[1])
    div = lambda a, x: rnd(a[0] / x, a[1] / x)
    for i, each in enumerate(regressors):
        truth = max(map(abs, each["theta"]))
        W += max(abs(a * b - d) for a in g for b in each["theta_hat"] for d in each["theta"]) * each["magnitude"]
        xi, load = xi + truth * each["rate"], load + truth * each["magnitude"]
        product = mul((max(map(abs, each["theta_hat"])), 0), (each["magnitude"], 0))
        comp = add(comp, product) if i else product
    U = (r + S + lam * Z + load) / plant["alpha"][0]
    # One step, line by line.
    e = add((S + lam * Z, 0), (F(0), 0))
    Es = add(e, mul((lam, 0), (Z, 0)))[1]
    rate = div(add(div(add((h * plant["reference_rate"], 0), (F(0), 0)), h), (Z, 0)), lam)
    ubar = add(add(add(add(mul((k, 0), (S + Es, 0)), (r, 0)), rate), comp), mul((delta, 0), (F(1), 0)))
    way = add(mul((beta[1], 0), ubar), (U, 0))
    moved = mul(mul((h, 0), (lam, 0)), way)
    summed = lambda value, inc, owed: add((value, 0), add(inc, (F(0), owed)))
    El = summed(U, moved, u * U)[1]
    inc = mul((h, 0), e)
    carry = u * (Z + inc[0]) * (1 + F(1, 1024))
    w = add(inc, (F(0), carry))
    Ez, owed = summed(Z, inc, carry)[1], u * (Z + w[0] + w[1])
    q = (1 + 8 * u) / gains["epsilon"]
    Rs = plant["alpha"][1] * El + lam * Ez + h * lam * g[1] * delta * 4 * eta
    # More than any number of the step, and the greatest float.
    big = 1 + h + r + (S + Es + lam * Z + plant["reference_rate"]) * (1 + h) + Z + U
    big += sum(each["magnitude"] for each in regressors)
    big += (S + Es) / gains["epsilon"] + ubar[0] * (1 + beta[1])
    # The estimates' updates: distance from the prior, drive, leakage, what a step takes of both.
    pull = lam * (S + Es)
    drives = [(beta, pull * ubar[0]), (gains["delta"], pull)]
    drives += [(each["theta_hat"], pull * each["magnitude"]) for each in regressors]
    big += pull
    for (low, high), drive in drives:
        m, sigma = (gains["adaptation"], gains["leakage"]) if low < high else (0, 0)
        rate = m * drive + sigma * (high - low)
        big += 1 + (high - low) + max(abs(low), abs(high)) + sigma * (1 + h) + drive + rate * (1 + h)
    big = 2 * big
    top = (2 - 2 * u) * F(2) ** {"f32": 127, "f64": 1023}[c["float"]]
    over = lam * Z - S
    slew = []
    if gains["slew"] is not None:
        # What the law adds to the command, by the plant's own command; then slew·dt and its sum.
        moves = lam * (W + g[1] * (k * (S + Es) + delta)) + g[1] * Z + plant["reference_rate"] + lam * (S + lam * Z)
        reach = h * gains["slew"]
        slew = [("slew", h * moves / plant["alpha"][0] + El, reach - u * (4 * reach + U) - 2 * eta)]
    return [("step", h * lam, F(1)), ("steepness", h * lam * g[1] * (k + delta * q), F(1)),
            ("z-stays", h * S + Ez, h * lam * Z), ("stiffness", Z, lam * k * S),
            ("s-stays", h * lam * W + h * xi + Rs + Es, h * g[0] * (lam * k * S - Z)),
            ("owed", owed, carry), ("z-limit", Z, gains["z_limit"]), ("command", U, gains["command"]),
            ("overflow", big, top),
            ("reserve", (r + load + over) / plant["alpha"][0], gains["command"]),
            ("waiting", h * lam * (2 + g[1] * k), F(1)), ("slack", lam ** 2 * Z, lam * S + 2 * g[0] * Z)] + slew


def faults(c):
    near = F(1, 2 ** 45)
    fails = set()
    for (name, left, right), stated in zip(sides(c), c["inequalities"] + c["at_the_limit"] + [c["slew"]] * (c["slew"] is not None), strict=True):
        a, b = number(stated["left"]["exact"]), number(stated["right"]["exact"])
        if name != stated["name"]:
            yield f"{stated['name']} stands where {name} is needed"
        if not left <= a <= left + near * abs(left):
            yield f"{name}: left side {float(a)} is not {float(left)}"
        if not right - near * abs(right) <= b <= right:
            yield f"{name}: right side {float(b)} is not {float(right)}"
        if (a <= b) != stated["holds"]:
            yield f"{name}: {float(a)} <= {float(b)} is not as stated"
        if a > b:
            fails.add(name)
    # A limit that is not met, or one that may be.
    limit, own = {"reserve", "waiting", "slack"}, fails - {"reserve", "waiting", "slack"}
    if c["may_meet_the_limit"] != ("command" in fails):
        yield "may_meet_the_limit is not as stated"
    if c["proved"] != (not own or (own == {"command"} and not fails & limit)):
        yield f"proved is {c['proved']} with {sorted(fails)}"


def main():
    bad = total = 0
    for line in sys.stdin:
        certificate, total = json.loads(line), total + 1
        found = list(faults(certificate))
        bad += bool(found)
        print(f"{total}: {'; '.join(found) or 'ok'}")
    return int(bad > 0 or total == 0)


if __name__ == "__main__":
    sys.exit(main())
