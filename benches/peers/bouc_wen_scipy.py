"""Bouc-Wen fitted to a record with SciPy, as a Python user would do it.

    python3 benches/peers/bouc_wen_scipy.py RECORD.csv [--thin K]

Reads the columns `t`, `tau_i` and `tau_o` and fits

    tau_o = B tau_i - kappa_eta eta - T0
    eta'  = rho (tau_i' - sigma |tau_i'| |eta|^(n-1) eta + (sigma - 1) tau_i' |eta|^n)

by `scipy.optimize.differential_evolution` over (rho, sigma, n), then by
`scipy.optimize.least_squares` over (rho, sigma, n, eta(0)). B, kappa_eta and T0 are linear:
`numpy.linalg.lstsq` gives them for each trial, which spares both searches half of their
parameters. The state is integrated by fourth-order Runge-Kutta with one step a sample; all
members of a population, and all differences of a Jacobian, go through one loop over the
samples. `--thin K` keeps every K-th sample after a mean over K.

Prints one JSON object. Needs Python 3.8 or later with NumPy and SciPy.
"""

import argparse
import csv
import json
import sys
import time

import numpy as np
from scipy.optimize import differential_evolution, least_squares

# Searched ranges. rho is in units of one over the input's half-range.
LOWER = np.array([0.1, 0.5, 1.0])
UPPER = np.array([100.0, 100.0, 10.0])


def read(path):
    """Columns t, tau_i and tau_o; a header's unit, `name [unit]`, is dropped."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        names = [cell.split("[")[0].strip() for cell in next(rows)]
        wanted = [names.index(name) for name in ("t", "tau_i", "tau_o")]
        table = np.array([[float(row[i]) for i in wanted] for row in rows])
    return table.T


def thinned(column, by):
    """Means of `by` neighbours."""
    whole = len(column) // by * by
    return column[:whole].reshape(-1, by).mean(axis=1)


class Problem:
    """A record, and how often the model was evaluated on it."""

    def __init__(self, tau_i, tau_o):
        self.reach = 0.5 * (tau_i.max() - tau_i.min())
        self.tau_i, self.tau_o = tau_i, tau_o
        self.steps = np.diff(tau_i)
        self.evaluations = 0

    def states(self, rho, sigma, n, start):
        """eta at each sample, one column for each set of parameters."""
        self.evaluations += len(rho)
        rho = rho / self.reach
        eta = np.array(start, dtype=float)
        out = np.empty((len(self.tau_i), len(rho)))
        out[0] = eta

        def slope(eta, direction):
            # d eta / d |tau_i|, which is the form whose step is the input's. A stage of
            # Runge-Kutta may leave the range that the model keeps; so may its result.
            eta = np.clip(eta, -1.0, 1.0)
            power = np.abs(eta) ** (n - 1.0)
            return rho * (direction - sigma * power * eta + (sigma - 1.0) * direction * power * np.abs(eta))

        for k, step in enumerate(self.steps):
            direction, length = np.sign(step), abs(step)
            a = slope(eta, direction)
            b = slope(eta + 0.5 * length * a, direction)
            c = slope(eta + 0.5 * length * b, direction)
            d = slope(eta + length * c, direction)
            eta = np.clip(eta + length / 6.0 * (a + 2.0 * b + 2.0 * c + d), -1.0, 1.0)
            out[k + 1] = eta
        return out

    def residuals(self, states):
        """Residual and gains (B, kappa_eta, T0) for each column of states."""
        residuals, gains = [], []
        for eta in states.T:
            columns = np.column_stack([self.tau_i, -eta, -np.ones_like(eta)])
            own, *_ = np.linalg.lstsq(columns, self.tau_o, rcond=None)
            residuals.append(self.tau_o - columns @ own)
            gains.append(own)
        return np.array(residuals).T, gains

    def rms(self, population):
        """What differential evolution minimises; one value for each column."""
        population = np.atleast_2d(population.T).T
        states = self.states(*population, np.zeros(population.shape[1]))
        residuals, _ = self.residuals(states)
        return np.sqrt(np.mean(residuals**2, axis=0))

    def residual(self, at):
        states = self.states(*(np.array([value]) for value in at))
        return self.residuals(states)[0][:, 0]

    def jacobian(self, at):
        """Forward differences, all of them in one pass."""
        steps = 1e-6 * np.maximum(np.abs(at), 1e-3)
        # Away from the upper bounds.
        steps = np.where(at + steps > np.append(UPPER, 1.0), -steps, steps)
        trials = np.column_stack([at] + [at + step * unit for step, unit in zip(steps, np.eye(4))])
        residuals, _ = self.residuals(self.states(*trials))
        return (residuals[:, 1:] - residuals[:, :1]) / steps


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("record")
    parser.add_argument("--thin", type=int, default=1, metavar="K")
    arguments = parser.parse_args()
    begun = time.perf_counter()
    _, tau_i, tau_o = (thinned(column, arguments.thin) for column in read(arguments.record))
    problem = Problem(tau_i, tau_o)
    found = differential_evolution(
        problem.rms,
        list(zip(LOWER, UPPER)),
        seed=1,
        vectorized=True,
        updating="deferred",
        polish=False,
        tol=1e-3,
    )
    inside = np.clip(np.append(found.x, 0.0), np.append(LOWER, -0.99), np.append(UPPER, 0.99))
    best = least_squares(
        problem.residual,
        inside,
        jac=problem.jacobian,
        bounds=(np.append(LOWER, -1.0), np.append(UPPER, 1.0)),
        x_scale=np.maximum(np.abs(inside), 0.1),
    )
    rho, sigma, n, start = best.x
    residuals, gains = problem.residuals(problem.states(*(np.array([v]) for v in best.x)))
    b, kappa_eta, t0 = gains[0]
    json.dump(
        {
            "seconds": time.perf_counter() - begun,
            "samples": len(tau_i),
            "evaluations": problem.evaluations,
            "rmse": float(np.sqrt(np.mean(residuals**2))),
            "rho": rho / problem.reach,
            "sigma": sigma,
            "n": n,
            "B": b,
            "kappa_eta": kappa_eta,
            "T0": t0,
            "eta0": start,
        },
        sys.stdout,
    )
    print()


if __name__ == "__main__":
    main()
