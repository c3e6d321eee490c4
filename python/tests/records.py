"""Test records, made here in numpy alone: none of this code is the package's."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

RATE = 200.0


def multisine(t: np.ndarray, rng: np.random.Generator, top: float, low: float, high: float) -> np.ndarray:
    """Seven tones between `low` and `high` Hz, of `top` as the greatest value."""
    tones = np.geomspace(low, high, 7) * rng.uniform(0.95, 1.05, 7)
    phases = rng.uniform(0.0, 2.0 * np.pi, 7)
    all = sum(np.sin(2.0 * np.pi * f * t + p) / (1.0 + f) for f, p in zip(tones, phases))
    return top * all / np.max(np.abs(all))


def bouc_wen(u: np.ndarray, rho: float, sigma: float, n: float) -> np.ndarray:
    """eta of (2) by explicit steps of a fiftieth of each sample's change."""
    eta, out = 0.0, np.empty_like(u)
    out[0] = eta
    for i in range(1, len(u)):
        du = (u[i] - u[i - 1]) / 50.0
        for _ in range(50):
            power = abs(eta) ** (n - 1.0)
            eta += rho * (du - sigma * abs(du) * power * eta + (sigma - 1.0) * du * power * abs(eta))
        out[i] = eta
    return out


def torque(
    seed: int = 1,
    seconds: float = 30.0,
    viscous: float = 0.0,
    noise: float = 0.02,
    gain: float = 0.95,
) -> dict[str, Any]:
    """A record of torque mode: tau_o = B tau_i - kappa eta - T0 - viscous dphi_p/dt, with noise."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds * RATE)) / RATE
    tau_i = multisine(t, rng, 14.0, 0.1, 1.0)
    phi_p = multisine(t, rng, 0.5, 0.15, 1.6)
    rate = np.gradient(phi_p, t)
    eta = bouc_wen(tau_i, 0.25, 0.6, 1.5)
    tau_o = gain * tau_i - 2.0 * eta - 0.3 - viscous * rate
    return {
        "t": t,
        "tau_i": tau_i + rng.normal(0.0, noise, len(t)),
        "tau_o": tau_o + rng.normal(0.0, noise, len(t)),
        "phi_p": phi_p,
    }


def hard(seed: int = 1) -> dict[str, Any]:
    """A record that lacks much, at four further channels: its search takes long."""
    record = torque(seed=seed, seconds=120.0, viscous=1.2)
    rng = np.random.default_rng(5)
    t, tau_i, phi = record["t"], record["tau_i"], record["phi_p"]
    rate = np.gradient(phi, t)
    more = 0.8 * np.tanh(9.0 * rate) + 0.5 * np.sin(9.0 * phi) + 1.2 * phi * np.abs(phi)
    more += 0.3 * np.sin(2.0 * np.pi * 0.37 * t) + 0.3 * np.sign(np.sin(3.0 * phi + tau_i))
    for k in range(4):
        own = multisine(t, rng, 1.0, 0.1, 1.5)
        record[f"c{k}"] = own
        more += 0.3 * own**3 + 0.1 * np.abs(own)
    record["tau_o"] = record["tau_o"] + more
    return record


def write_csv(path: Path, record: dict[str, Any]) -> Path:
    """Each number in the shortest decimals that read back as it is."""
    columns = [np.asarray(values, dtype=np.float64).tolist() for values in record.values()]
    lines = [",".join(record)] + [",".join(map(repr, row)) for row in zip(*columns)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path
