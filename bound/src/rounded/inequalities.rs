//! The inequalities, with both sides.

use super::gains::Gains;
use super::roundings::{roundings, Roundings};
use super::PeakRounded;
use crate::dyadic::{Dyadic, Enclosure};

/// Name of an inequality.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Named {
    /// `h·lambda <= 1`.
    Step,
    /// `h·lambda·g⁺·(k + delta_hat·q) <= 1`, where q is the largest `T(s/epsilon)/s`.
    Steepness,
    /// `h·S + E_z <= h·lambda·Z`.
    ZStays,
    /// `Z <= lambda·k·S`.
    Stiffness,
    /// `h·lambda·W + h·Xi + R_s + E_s <= h·g⁻·(lambda·k·S - Z)`.
    SStays,
    /// The carry of z's sum after a step is at most its permitted maximum.
    Owed,
    /// `Z <= z_limit`.
    ZLimit,
    /// `(r + S + lambda·Z + theta'x + D)/alpha⁻ <=` the command limit, which is then not active.
    Command,
    /// Twice the sum of all numbers that the step adds and multiplies, including the updates of the
    /// estimates, `<=` the largest float.
    Overflow,
    /// `(r + theta'x + D + lambda·Z - S)/alpha⁻ <=` the command limit, which may be active.
    Reserve,
    /// `h·lambda·(2 + g⁺·k) <= 1`. While z is frozen, one step does not overshoot the box.
    Waiting,
    /// `lambda²·Z <= lambda·S + 2·g⁻·Z`, which is the margin of Z for rounding errors while z is
    /// frozen.
    Slack,
    /// The change of the command in a step `<=` the change that the slew-rate limit allows, so this
    /// limit is not active.
    /// `h·(lambda·(W + g⁺·(k·S + delta_hat)) + g⁺·Z + r' + lambda·(S + lambda·Z))/alpha⁻` plus the
    /// rounding errors `E_c` of the command `<= h·slew`.
    Slew,
}

impl Named {
    /// The inequality in words and symbols.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Step => "h*lambda <= 1",
            Self::Steepness => "h*lambda*g+*(k + delta*q) <= 1",
            Self::ZStays => "z stays: h*S + Ez <= h*lambda*Z",
            Self::Stiffness => "Z <= lambda*k*S",
            Self::SStays => "s stays: h*lambda*W + h*Xi + Rs + Es <= h*g-*(lambda*k*S - Z)",
            Self::Owed => "what the sum of z owes reproduces itself",
            Self::ZLimit => "Z <= z_limit",
            Self::Command => "(r + S + lambda*Z + load)/alpha- <= limit of the command",
            Self::Overflow => "no number of the step overflows, including the numbers of the estimates",
            Self::Reserve => "(r + load + lambda*Z - S)/alpha- <= limit of the command",
            Self::Waiting => "h*lambda*(2 + g+*k) <= 1",
            Self::Slack => "lambda^2*Z <= lambda*S + 2*g-*Z",
            Self::Slew => {
                "a step moves the command by less than the slew rate allows: h*(lambda*(W + g+*(k*S + delta)) + g+*Z + r' + lambda*(S + lambda*Z))/alpha- + Ec (the roundings of the command) <= h*slew"
            }
        }
    }
}

/// One inequality. Both sides are rounded against the claim.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Inequality {
    /// Name of the inequality.
    pub name: Named,
    /// Upper bound on the left side.
    pub left: Dyadic,
    /// Lower bound on the right side.
    pub right: Dyadic,
}

impl Inequality {
    fn new(name: Named, left: Enclosure, right: Enclosure) -> Self {
        Self {
            name,
            left: left.high,
            right: right.low,
        }
    }

    /// Whether the inequality holds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.left <= self.right
    }
}

/// Bits of Z: few, so Z has a short notation.
const BITS_OF_Z: u32 = 40;

/// Rounds of the search for Z.
const ROUNDS: u32 = 4;

impl Gains {
    /// S of [`PeakSampled`](crate::PeakSampled); one if there is none.
    pub(super) fn exact_box(&self) -> Enclosure {
        let stiffness = self.gain - Enclosure::ONE / (self.lambda * self.lambda);
        if stiffness.is_at_most(Enclosure::ZERO) {
            return Enclosure::ONE;
        }
        let s = (self.w + self.xi / self.lambda) / (self.g[0] * stiffness);
        Enclosure::exactly(s.high.shortened(20))
    }

    /// The command that a box needs \[command unit\].
    fn needed(&self, s: Enclosure, z: Enclosure) -> Enclosure {
        (self.reference + s + self.lambda * z + self.load) / self.alpha[0]
    }

    /// Z for an S: S/lambda, with a margin for the rounding of z.
    fn z(&self, s: Enclosure) -> Enclosure {
        let above = Enclosure::ONE + Enclosure::power(-20);
        let mut z = s / self.lambda;
        for _ in 0..ROUNDS {
            let added = roundings(self, s, z, self.needed(s, z)).z;
            z = (s + added * above / self.step) * above / self.lambda;
        }
        Enclosure::exactly(z.high.shortened(BITS_OF_Z))
    }
}

impl PeakRounded {
    /// Everything at one S.
    pub(super) fn at(gains: &Gains, s: Enclosure) -> Self {
        let z = gains.z(s);
        let command = gains.needed(s, z);
        let added = roundings(gains, s, z, command);
        Self {
            s,
            z,
            w: gains.w,
            xi: gains.xi,
            g: gains.g,
            error: s + gains.lambda * z,
            roundings: added,
            inequalities: inequalities(gains, s, z, command, &added),
            at_the_limit: at_the_limit(gains, s, z),
            slew: gains
                .slew
                .map(|slew| not_met(gains, slew, [s, z, command], &added)),
        }
    }
}

fn inequalities(
    gains: &Gains,
    s: Enclosure,
    z: Enclosure,
    command: Enclosure,
    added: &Roundings,
) -> [Inequality; 9] {
    let [_, alpha] = gains.alpha;
    let [g_low, g_high] = gains.g;
    let share = gains.step * gains.lambda;
    let steepest = gains.gain + gains.delta * gains.slope;
    let underflow = share * g_high * gains.delta * added.smooth_sign;
    let rs = alpha * added.command + gains.lambda * added.z + underflow;
    let pushed = share * gains.w + gains.step * gains.xi + rs + added.s;
    let stiff = gains.lambda * gains.gain * s;
    let one = Enclosure::ONE;
    [
        Inequality::new(Named::Step, share, one),
        Inequality::new(Named::Steepness, share * g_high * steepest, one),
        Inequality::new(Named::ZStays, gains.step * s + added.z, share * z),
        Inequality::new(Named::Stiffness, z, stiff),
        Inequality::new(Named::SStays, pushed, gains.step * g_low * (stiff - z)),
        Inequality::new(Named::Owed, added.owed_after, added.carry_error_z),
        Inequality::new(Named::ZLimit, z, gains.z_limit),
        Inequality::new(Named::Command, command, gains.command),
        Inequality::new(Named::Overflow, added.largest, gains.word.most),
    ]
}

/// If the limit of the command may be active: `theorems/Limit.v`.
fn at_the_limit(gains: &Gains, s: Enclosure, z: Enclosure) -> [Inequality; 3] {
    let two = Enclosure::power(1);
    let [g_low, g_high] = gains.g;
    let over = gains.lambda * z - s;
    let reserve = (gains.reference + gains.load + over) / gains.alpha[0];
    let waiting = gains.step * gains.lambda * (two + g_high * gains.gain);
    [
        Inequality::new(Named::Reserve, reserve, gains.command),
        Inequality::new(Named::Waiting, waiting, Enclosure::ONE),
        Inequality::new(
            Named::Slack,
            gains.lambda * (gains.lambda * z),
            gains.lambda * s + two * g_low * z,
        ),
    ]
}

/// No step changes the command by as much as the slew-rate limit allows: `theorems/Slew.v`.
///
/// The plant gives the applied command, `alpha·u = y + theta'x + D`, for any limit.
fn not_met(
    gains: &Gains,
    slew: Enclosure,
    [s, z, command]: [Enclosure; 3],
    added: &Roundings,
) -> Inequality {
    let [_, g_high] = gains.g;
    let (lambda, two) = (gains.lambda, Enclosure::power(1));
    let pulled = gains.w + g_high * (gains.gain * (s + added.s) + gains.delta);
    let rate = lambda * pulled + g_high * z + gains.reference_rate + lambda * (s + lambda * z);
    let reach = gains.step * slew;
    // The product slew·dt, and the sum with the command before.
    let word = &gains.word;
    let rounded = word.unit * (two * (reach + reach) + command) + two * word.least;
    Inequality::new(
        Named::Slew,
        gains.step * rate / gains.alpha[0] + added.command,
        reach - rounded,
    )
}
