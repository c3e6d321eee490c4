//! The normalised Bouc-Wen hysteresis, advanced along the path of its input.
//!
//! The state `eta` in `[-1, 1]` follows (2) and (7) of Nguyen et al. (2018):
//!
//! ```text
//! eta' = rho·(x' - sigma·|x'|·|eta|^(n-1)·eta + (sigma - 1)·x'·|eta|^n)
//! ```
//! Here `x` is a displacement or a torque:
//! - rho: initial slope of eta \[1/input unit\].
//! - sigma ≥ 1/2: the slope after a reversal is 2·sigma·rho.
//! - n ≥ 1: sharpness of the knee, larger is sharper.
//!
//! [`law`] implements this equation, which does not contain time. With `d = sgn(x')`, `zeta =
//! d·eta`, `c = 2·sigma - 1` and the path `p = rho·|dx|` it reads `dzeta/dp = f(zeta)`:
//!
//! - loading, `zeta >= 0`: `f = 1 - zeta^n`;
//! - unloading, `zeta < 0`: `f = 1 + c·|zeta|^n`.
//!
//! A reversal is `zeta -> -zeta`. A sample advances the state by an input increment, never by a
//! time step, so the result does not depend on the sampling rate.
//!
//! Two methods integrate along the path. Both keep `|eta| <= 1` for any increment.
//! - [`BoucWen::advance_split`] splits a long increment, so any jump is accurate. `f64`
//!   uses this method, for identification.
//! - [`BoucWen::advance_bounded`] takes any increment in one step, so the cost of a sample
//!   is bounded. `f32` uses this method, for control loops.
//!
//! # The splitting step
//! Write `a = |zeta|`. One power `a^(n-1)` gives `f` and the next two derivatives of the path:
//! `f' = -n·k·a^(n-1)` and
//! `|f''| = (n-1)·|f'|/a`, with `k = 1` (loading) or `c` (unloading). The Taylor
//! series `dzeta = p·f·(1 + p·f'/2 + p²·(f'² + f·f'')/6)`, written as a fraction, is
//!
//! `dzeta = p·f / (1 + p·|f'|/2 + p²·(f'²/12 - f·f''/6))`, of third order.
//!
//! While loading `f'' <= 0`, so every term of the denominator is positive. With `r = p·f/(1 -
//! zeta)` the denominator gets one more term, `27/256·r⁴`, because `1 + 27/256·r⁴ >= r` for every
//! `r`. Hence `0 <= dzeta <= 1 - zeta` for **any** step. While unloading the step ends at `zeta =
//! 0`. The path up to this point is the root of a quadratic, and the rest of the path is loading.
//! Comparisons enforce both bounds as well, so the bounds also hold in rounded arithmetic and with
//! an inaccurate power function.
//!
//! Where `n·(1 - zeta) <= 0.03` the rest of the path is a logistic equation with a closed-form
//! solution. The local error determines where a long increment is split, so the cost of a jump
//! grows only with `ln(sigma)`. A jump from one saturation to the other evaluates at most 30 powers
//! for `sigma = 0.6`, 55 for 98, and 100 for 1e6 (test in `garbage.rs`). A sampled signal needs one
//! power per sample.
//!
//! # The bounded-time step
//! For any increment, the step evaluates one power `a^(n-1)` and calls no libm function. The power
//! uses a base-2 logarithm and exponential with an error of 4e-7 (`src/real/short.rs`). The bounds
//! hold for any power function.
//!
//! - **Loading.** With `w = 1 - zeta`, `r = p·f/w`, `g = w·|f'|/f` the step is `dzeta = w·(1 -
//!   1/(1 + m)²)`, `m = r/2 + (3/8 - g/4)·r² + (5/16 - 3g/8 + g²/12)·r³`. The step is the Taylor
//!   series to `p³` without the `f''` term. As f is concave, `0 <= g <= 1`. No coefficient is
//!   negative, so dzeta increases with the path and does not exceed w.
//! - **Unloading.** The path from a to zero is `a·H`, `H = int_0^1 ds/(1 + x·s^n)`,
//!   `x = c·a^n`; `t = p/(a·H)` and `f = 1 + x`. Up to `n·x = 3`, H is a convergent of its
//!   continued fraction and `a` becomes `a·(1 - t)/(1 + α·t + β·t² + γ·t³)`. The coefficients
//!   match the slope and curvature of the path at its start and its slope at zero:
//!   `α = f·H - 1`, `β = f·H·(α - n·x·H/2)`, `γ = 1/H - 1 - α - β`. For larger `n·x`, a falls
//!   like a power: `a` becomes `a·(1 - t)/(1 + k·s)^(1/k)`, `k = n - 1`, with
//!   `s = α²·t/(α + δ·t/2)`, `δ = 1 + f·H²·(n·x - f) - k·α²`. The power is a fraction that
//!   agrees to `s²`, and H has an error of up to 7 %. The error of H moves the crossing, not
//!   the slope or curvature at the start.
//! - **From zero.** The series `p = zeta·(1 + zeta^n/(n+1) + zeta^(2n)/(2n+1) + …)` is inverted to
//!   `zeta = p/(1 + y + y²·(1 + n - n²)/(2n + 1))`, `y = p^n/(n + 1)`, up to `p = 1`. Beyond `p =
//!   1` the distance to saturation decays as in the loading step, at the rate n.
//!
//! # Accuracy
//! Error in `kappa_eta·eta` on `16·sin(pi·t)` at 1 kHz with the first identified set:
//!
//! | step | error \[N·m\] |
//! |---|---|
//! | splitting step | 1.0e-5 |
//! | bounded-time step | 2.4e-4 |
//! | `f32` as shipped | 2.5e-4 |
//! | `f32` as shipped, on the paper's walk | 3.4e-4; the rounding of the input alone gives the same error |
//!
//! On random jumps within ±16 N·m the splitting step has an error of at most 8e-4 of eta for every
//! tested shape (mean 1.6e-4). The next table lists the errors of the bounded-time step: the
//! largest error of eta in one step, and the mean in brackets. The jumps lie within ±0.3, ±3 and
//! ±16 N·m at `rho = 0.09582`, which are paths up to 0.06, 0.6 and 3:
//!
//! | n | ±0.3 N·m | ±3 N·m | ±16 N·m |
//! |---|---|---|---|
//! | 1 | 7.0e-9 (1.1e-9) | 3.3e-5 (7.1e-7) | 6.0e-3 (2.7e-4) |
//! | 1.5 | 5.3e-5 (1.1e-6) | 1.4e-2 (2.4e-4) | 7.1e-2 (3.3e-3) |
//! | 2 | 6.6e-6 (1.9e-7) | 5.4e-3 (1.4e-4) | 2.9e-2 (3.2e-3) |
//! | 3.871 | 2.9e-7 (6.9e-9) | 2.2e-3 (4.8e-5) | 6.0e-2 (4.5e-3) |
//! | 10 | 3.0e-7 (7.1e-9) | 2.6e-3 (6.4e-5) | 1.4e-1 (9.1e-3) |
//!
//! The table is for `sigma = 0.6`. With 98.36 the largest errors are 8.5e-4 (n = 1), 3.0e-2 (n =
//! 1.5) and 1.5e-1 (n = 10). A long jump ends near saturation, where earlier errors have decayed.
//!
//! `cargo bench --bench step` prints all of these numbers; the tests are in `tests/hysteresis`.
//!
//! # Slope
//! In the bounded-time step, eta rises by at most `2·sigma` times the path. This bound is proved up
//! to `n = 4` (`theorems/Slope.v`, over the reals) and measured up to `n = 10`. From about `n = 12`
//! on, the slope while unloading is up to 1.39 times this value, and an inverse near its largest
//! sigma may have more than one solution.
//!
//! Source: Bouc 1967, Wen 1976; equations (2), (7); Ikhouane & Rodellar,
//! *Systems with Hysteresis*, Wiley 2007, chapters 2 and 4.

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
