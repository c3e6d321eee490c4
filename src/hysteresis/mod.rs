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
//! # The unconditional step
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
//! A long increment is split where the local error asks for it, not evenly: one
//! reversal at full saturation costs about `(ln(2·sigma) + 4)/0.25` powers, 50 at
//! most for `sigma = 98` and any jump; a sampled signal almost always needs one.
//!
//! Source: Bouc 1967, Wen 1976; equations (2), (7); Ikhouane & Rodellar,
//! *Systems with Hysteresis*, Wiley 2007, chapters 2 and 4.

mod closed;
#[cfg(test)]
mod garbage;
mod number;
mod path;
mod shape;
mod stages;
mod state;
mod textbook;

pub use shape::Shape;
pub use state::{BoucWen, Sensitivity};
pub use textbook::{Actuator, Class, Loop, Textbook, TextbookReport};
