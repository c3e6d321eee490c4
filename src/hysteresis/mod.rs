//! The normalised Bouc-Wen hysteresis, advanced along the path of its input.
//!
//! The state `eta` in `[-1, 1]` follows (2) and (7) of the paper,
//! `eta' = rho·(x' - sigma·|x'|·|eta|^(n-1)·eta + (sigma - 1)·x'·|eta|^n)`,
//! where `x` is a displacement or a torque. Time does not occur in it. With
//! `d = sgn(x')`, `zeta = d·eta`, `c = 2·sigma - 1` and the path `p = rho·|dx|`
//! it reads `dzeta/dp = f(zeta)`:
//!
//! - loading, `zeta >= 0`: `f = 1 - zeta^n`;
//! - unloading, `zeta < 0`: `f = 1 + c·|zeta|^n`;
//!
//! and a reversal is `zeta -> -zeta`. So a sample advances the state by an input
//! increment, never by a time step, and the result does not depend on the rate.
//!
//! Two steps follow the path. [`Shape::advance_split`] splits a long increment, so that any
//! jump is accurate: for the bench, and what `f64` takes. [`Shape::advance_bounded`] takes any
//! increment in one go, so that a sample has a greatest cost: for a control loop, and what
//! `f32` takes. Both keep `|eta| <= 1` for any increment.
//!
//! # The step that splits
//! Write `a = |zeta|`. One power `a^(n-1)` gives `f`, and the next two derivatives
//! of the path follow without another: `f' = -n·k·a^(n-1)` and
//! `|f''| = (n-1)·|f'|/a`, with `k = 1` (loading) or `c` (unloading). The Taylor
//! series `dzeta = p·f·(1 + p·f'/2 + p²·(f'² + f·f'')/6)`, written as a fraction, is
//!
//! `dzeta = p·f / (1 + p·|f'|/2 + p²·(f'²/12 - f·f''/6))`, of third order.
//!
//! While loading `f'' <= 0`, so every term of the denominator is positive; with
//! `r = p·f/(1 - zeta)` it gets one more, `27/256·r⁴`, because
//! `1 + 27/256·r⁴ >= r` for every `r`. Hence `0 <= dzeta <= 1 - zeta` for **any**
//! step. While unloading the step ends at `zeta = 0`, the path used up to there is
//! the root of a quadratic, and the rest of the path is loading. Both bounds are
//! enforced by comparisons as well, so they hold in rounded arithmetic and even
//! for a wrong power function.
//!
//! Where `n·(1 - zeta) <= 0.03` the rest of the path is a logistic equation, solved in
//! one go. A long increment is split where the local error asks for it, not evenly, so
//! that the price of a jump grows with `ln(sigma)` only: from full saturation to full
//! saturation at most 30 powers for `sigma = 0.6`, 55 for 98, 100 for 1e6 (test in
//! `garbage.rs`). Sampled signals take one.
//!
//! # The step in bounded time
//! One power `a^(n-1)` and no function of libm, whatever the increment. The power comes from
//! a base-2 logarithm and exponential of 4e-7 (`src/real/short.rs`); the bounds hold for any.
//!
//! - **Loading.** With `w = 1 - zeta`, `r = p·f/w`, `g = w·|f'|/f` the step is
//!   `dzeta = w·(1 - 1/(1 + m)²)`, `m = r/2 + (3/8 - g/4)·r² + (5/16 - 3g/8 + g²/12)·r³`: the
//!   Taylor series to `p³`, but for `f''`. As f is concave, `0 <= g <= 1`; so no coefficient is
//!   negative, and a longer path leads further, to 1 at most.
//! - **Unloading.** The path from a to zero is `a·H`, `H = int_0^1 ds/(1 + x·s^n)`,
//!   `x = c·a^n`; `t = p/(a·H)` and `f = 1 + x`. Up to `n·x = 3`, H is a convergent of its
//!   continued fraction and `a` becomes `a·(1 - t)/(1 + α·t + β·t² + γ·t³)`, with the slope and
//!   curvature of the path at its start and its slope at zero: `α = f·H - 1`,
//!   `β = f·H·(α - n·x·H/2)`, `γ = 1/H - 1 - α - β`. Beyond, a falls like a power: `a` becomes
//!   `a·(1 - t)/(1 + k·s)^(1/k)`, `k = n - 1`, with `s = α²·t/(α + δ·t/2)`,
//!   `δ = 1 + f·H²·(n·x - f) - k·α²`, the power as a fraction that agrees to `s²`, and H to 7 %;
//!   the error of H moves the crossing, not the slope or curvature at the start.
//! - **From zero.** `p = zeta·(1 + zeta^n/(n+1) + zeta^(2n)/(2n+1) + …)` turned round to
//!   `zeta = p/(1 + y + y²·(1 + n - n²)/(2n + 1))`, `y = p^n/(n + 1)`, up to `p = 1`; from
//!   there the room that is left decays as above at the rate n.
//!
//! # Accuracy
//! Error in `kappa_eta·eta` on `16·sin(pi·t)` at 1 kHz with the first identified set: 1.0e-5 N·m
//! for the step that splits, 2.4e-4 in bounded time, 5.0e-8 for four stages; `f32` as it ships
//! 2.5e-4, and 3.4e-4 on the paper's walk, where rounding the input alone does as much. On
//! random jumps within ±16 N·m the step that
//! splits is off by at most 8e-4 of eta for every shape that was tried (mean 1.6e-4). In bounded
//! time a jump is off by (greatest error of eta in one step, mean in brackets; jumps within
//! ±0.3, ±3 and ±16 N·m at `rho = 0.09582`, paths up to 0.06, 0.6 and 3):
//!
//! | n | ±0.3 N·m | ±3 N·m | ±16 N·m |
//! |---|---|---|---|
//! | 1 | 7.0e-9 (1.1e-9) | 3.3e-5 (7.1e-7) | 6.0e-3 (2.7e-4) |
//! | 1.5 | 5.3e-5 (1.1e-6) | 1.4e-2 (2.4e-4) | 7.1e-2 (3.3e-3) |
//! | 2 | 6.6e-6 (1.9e-7) | 5.4e-3 (1.4e-4) | 2.9e-2 (3.2e-3) |
//! | 3.871 | 2.9e-7 (6.9e-9) | 2.2e-3 (4.8e-5) | 6.0e-2 (4.5e-3) |
//! | 10 | 3.0e-7 (7.1e-9) | 2.6e-3 (6.4e-5) | 1.4e-1 (9.1e-3) |
//!
//! for `sigma = 0.6`; with 98.36 the worst are 8.5e-4 (n = 1), 3.0e-2 (n = 1.5) and 1.5e-1
//! (n = 10). A long jump ends near saturation and forgets its error on the way.
//!
//! All from `cargo bench --bench step`; the tests are in `tests/hysteresis`.
//!
//! # Slope
//! In bounded time eta rises by at most `2·sigma` of the path up to `n = 4` (`theorems/Slope.v`,
//! over the reals), up to 10 as measured; from about `n = 12` on by up to 1.39 of that where it
//! unloads. An inverse that is close to its greatest sigma may then have more than one answer.
//!
//! Source: Bouc 1967, Wen 1976; equations (2), (7); Ikhouane & Rodellar,
//! *Systems with Hysteresis*, Wiley 2007, chapters 2 and 4.

mod bounded;
mod closed;
#[cfg(test)]
mod garbage;
mod number;
mod path;
#[cfg(kani)]
#[path = "../../proofs/hysteresis.rs"]
mod proofs;
mod shape;
mod stages;
mod state;
mod textbook;

pub use shape::Shape;
pub use state::{BoucWen, Sensitivity};
pub use textbook::{Actuator, Class, Loop, Textbook, TextbookReport};
