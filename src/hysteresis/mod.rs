//! The normalised Bouc-Wen hysteresis, advanced along the path of its input.
//!
//! The state `eta` in `[-1, 1]` follows (2) and (7) of Nguyen et al. (2018):
//!
//! ```text
//! eta' = rho·(x' - sigma·|x'|·|eta|^(n-1)·eta + (sigma - 1)·x'·|eta|^n)
//! ```
//! The input `x` is a displacement or a torque. The parameters are:
//! - rho: initial slope of eta \[1/input unit\].
//! - sigma ≥ 1/2: the slope after a reversal is 2·sigma·rho.
//! - n ≥ 1: sharpness of the knee, larger is sharper.
//!
//! [`law`] implements this equation. Let `d = sgn(x')`, `zeta = d·eta` and `c = 2·sigma - 1`. The
//! path p is defined by `dp = rho·|dx|`. The equation then becomes `dzeta/dp = f(zeta)`, which does
//! not contain time:
//!
//! - loading, `zeta >= 0`: `f = 1 - zeta^n`;
//! - unloading, `zeta < 0`: `f = 1 + c·|zeta|^n`.
//!
//! A reversal is `zeta -> -zeta`. A sample advances the state by an increment of the input, not of
//! time, so the result does not depend on the sampling rate.
//!
//! Two methods integrate the equation along the path. Both keep `|eta| <= 1` for any increment.
//! - [`BoucWen::advance_split`] splits a long increment, so the result is accurate for an increment
//!   of any size. `f64` uses this method, for identification.
//! - [`BoucWen::advance_bounded`] takes any increment in one step, so the computing time is
//!   bounded. `f32` uses this method, for control loops.
//!
//! # The splitting step
//! Let `a = |zeta|`. One power `a^(n-1)` gives `f` and its first two derivatives:
//! `f' = -n·k·a^(n-1)` and `|f''| = (n-1)·|f'|/a`, with `k = 1` (loading) or `c` (unloading). The
//! step replaces the Taylor series `dzeta = p·f·(1 + p·f'/2 + p²·(f'² + f·f'')/6)` with a fraction
//! that agrees with it to third order:
//!
//! `dzeta = p·f / (1 + p·|f'|/2 + p²·(f'²/12 - f·f''/6))`.
//!
//! During loading, `f'' <= 0`, so no term of the denominator is negative. The denominator has an
//! additional term `27/256·r⁴` with `r = p·f/(1 - zeta)`. Since `1 + 27/256·r⁴ >= r` for every `r`,
//! `0 <= dzeta <= 1 - zeta` for **any** step. During unloading, the step ends at `zeta = 0`. The
//! path to this point is the root of a quadratic equation, and the rest of the path is loading.
//! Comparisons enforce both bounds despite rounding errors.
//!
//! If `n·(1 - zeta) <= 0.03`, the rest of the path follows a logistic equation with a closed-form
//! solution. The local error determines where a long increment is split, so the cost of a jump
//! grows only with `ln(sigma)`. A jump from one saturation to the opposite saturation evaluates at
//! most 30 powers for `sigma = 0.6`, 55 for 98, and 100 for 1e6.
//!
//! # The bounded-time step
//! For any increment, the step evaluates one power `a^(n-1)` and at most two coarse powers. In
//! `f32`, it calls no libm function, because the power is computed from a base-2 logarithm and
//! exponential with a relative error of up to 4e-7. The bounds hold for any power function.
//!
//! - **Loading.** With `w = 1 - zeta`, `r = p·f/w` and `g = w·|f'|/f`, the step is
//!   `dzeta = w·(1 - 1/(1 + m)²)` with `m = r/2 + (3/8 - g/4)·r² + (5/16 - 3g/8 + g²/12)·r³`. Up to
//!   `p³`, the Taylor series of this step equals the series of the equation without the `f''` term.
//!   Since f is concave, `0 <= g <= 1`. No coefficient of m is negative, so dzeta increases with
//!   the path and does not exceed w.
//! - **Unloading.** The path from a to zero is `a·H` with `H = int_0^1 ds/(1 + x·s^n)` and
//!   `x = c·a^n`. Let `t = p/(a·H)` and `f = 1 + x`. Up to `n·x = 3`, H is a convergent of its
//!   continued fraction, and `a` becomes `a·(1 - t)/(1 + α·t + β·t² + γ·t³)`. The coefficients
//!   match the slope and curvature of the path at its start and the slope at zero: `α = f·H - 1`,
//!   `β = f·H·(α - n·x·H/2)`, `γ = 1/H - 1 - α - β`. For larger `n·x`, `a` decreases as a power: it
//!   becomes `a·(1 - t)/(1 + k·s)^(1/k)` with `k = n - 1`, `s = α²·t/(α + δ·t/2)` and
//!   `δ = 1 + f·H²·(n·x - f) - k·α²`. A fraction that agrees to `s²` replaces the power, and H has
//!   an error of up to 7 %. This error changes the zero crossing, but not the slope or curvature at
//!   the start.
//! - **From zero.** Up to `p = 1`, the inverse of the series
//!   `p = zeta·(1 + zeta^n/(n+1) + zeta^(2n)/(2n+1) + …)` is
//!   `zeta = p/(1 + y + y²·(1 + n - n²)/(2n + 1))` with `y = p^n/(n + 1)`. Beyond `p = 1`, the
//!   distance to saturation decays as in the loading step, at the rate n.
//!
//! # Accuracy
//! The table lists the error of `kappa_eta·eta` for the input `16·sin(pi·t)` at 1 kHz and the first
//! parameter set of Nguyen et al. (2018):
//!
//! | step | error \[N·m\] |
//! |---|---|
//! | splitting step | 1.0e-5 |
//! | bounded-time step in `f64` | 2.4e-4 |
//! | bounded-time step in `f32` | 2.5e-4 |
//! | the same, on the torque reference of the paper | 3.4e-4, mainly from the rounded input |
//!
//! For random jumps within ±16 N·m, the splitting step has an error in eta of at most 8e-4 for
//! every tested shape. The next table lists the largest error in eta of one bounded-time step in
//! `f32`, for `sigma = 0.6` and `rho = 0.09582`. The mean error is in brackets. The jumps are
//! within ±0.3, ±3 and ±16 N·m, so the paths are up to 0.06, 0.6 and 3:
//!
//! | n | ±0.3 N·m | ±3 N·m | ±16 N·m |
//! |---|---|---|---|
//! | 1 | 7.0e-9 (1.1e-9) | 3.3e-5 (7.1e-7) | 6.0e-3 (2.7e-4) |
//! | 1.5 | 5.3e-5 (1.1e-6) | 1.4e-2 (2.4e-4) | 7.1e-2 (3.3e-3) |
//! | 2 | 6.6e-6 (1.9e-7) | 5.4e-3 (1.4e-4) | 2.9e-2 (3.2e-3) |
//! | 3.871 | 2.9e-7 (6.9e-9) | 2.2e-3 (4.8e-5) | 6.0e-2 (4.5e-3) |
//! | 10 | 3.0e-7 (7.1e-9) | 2.6e-3 (6.4e-5) | 1.4e-1 (9.1e-3) |
//!
//! With `sigma = 98.36`, the largest errors are 8.5e-4 (`n = 1`), 3.0e-2 (`n = 1.5`) and 1.5e-1
//! (`n = 10`).
//!
//! `cargo bench --bench step` prints the errors for the sinusoidal input, and the second table.
//! Tests of the accuracy are in `tests/hysteresis`.
//!
//! # Slope
//! In the bounded-time step, eta changes by at most `2·sigma` times the path. This bound is proved
//! up to `n = 4` (`theorems/Slope.v`, over the reals) and measured up to `n = 10`. For n of about
//! 12 or more, the slope during unloading may be up to 1.39 times this bound. With a sigma near the
//! largest invertible value, the inverse may then have more than one solution.
//!
//! Source: Bouc 1967; Wen 1976; Ikhouane & Rodellar, *Systems with Hysteresis*, Wiley 2007,
//! chapters 2 and 4.

mod bounded;
mod closed;
#[cfg(test)]
mod garbage;
pub mod law;
mod number;
mod path;
#[cfg(kani)]
#[path = "../../proofs/hysteresis.rs"]
mod proofs;
mod shape;
mod state;

pub use shape::BoucWen;
pub use state::{BoucWenState, Sensitivity};
