/* bowden: hysteretic cable transmissions and their control. Made by `cargo xtask header` from
 * the sources in capi/src; do not edit. C99, C++11.
 *
 * Every function exists for float and for double: NAME_f32 and NAME_f64.
 *
 * Memory. Nothing is allocated. An object (bowden_pid_f32, ...) is a struct that the caller owns:
 * static, on the stack, or in another struct. NAME_init checks the settings and initialises the
 * object. It may be copied and moved as a whole, and needs no destructor. Every other function
 * returns BOWDEN_RESULT_ERROR_UNINITIALISED for an uninitialised object. The caller also owns the
 * arrays of a bowden_iterative_learning_f32, which must not move while the object is used.
 *
 * Settings. Start a settings struct from its macro, then set its fields:
 *
 *     bowden_pid_settings_f32 settings = BOWDEN_PID_SETTINGS_F32_INIT;
 *     settings.k_p = 30.0f;
 *
 * The macro sets the defaults and a mark. NAME_init refuses settings without the mark, because C
 * sets fields that an initialiser does not name to zero. For a field that must be set, the macro
 * contains an invalid value, which NAME_init refuses by name. An estimate of the adaptive law has
 * its own macro:
 *
 *     settings.theta[0] = (bowden_estimator_f32)BOWDEN_ESTIMATOR_F32_INIT;
 *
 * Limits and fallback are parts of settings and have no macro.
 *
 * Pointers. A pointer is null or points to memory of its type. Null and misaligned pointers are
 * reported; other invalid pointers cannot be detected. Do not use an object from two threads, or
 * from a task and its interrupt, at the same time.
 *
 * Results. 0: success. Above 0: a sample was not good, but the output is written. Below 0: nothing
 * was done and nothing was written. Test for `< 0`, then read the value.
 *
 * Bad samples. A NaN or an infinity in a measurement, in the reference or in dt, or a dt that is
 * not positive or too long, leaves the state unchanged and holds the last good command. After too
 * many bad samples the safe command is applied until it is acknowledged, even if later samples are
 * good. The command is always finite and within the limits.
 *
 * Numbers in brackets, such as (14), are the equations of the paper: T. L. Nguyen, S. Allen and
 * S. J. Phee, "Direct torque control for cable conduit mechanisms for the robotic foot for footwear
 * testing" (2018). Units are in square brackets. */


#ifndef BOWDEN_H
#define BOWDEN_H

#include <stddef.h>
#include <stdint.h>

// Maximum number of regressors of an adaptive law.
#define BOWDEN_REGRESSORS 4

// Size of a bowden_adaptive_f32 in 64-bit words.
#define BOWDEN_ADAPTIVE_F32_WORDS 56

// Size of a bowden_adaptive_f64 in 64-bit words.
#define BOWDEN_ADAPTIVE_F64_WORDS 104

// Maximum number of ranges of a compensator.
#define BOWDEN_RANGES 17

// Source of a range: the transmission's input.
#define BOWDEN_SOURCE_INPUT 4294967295

// Size of a bowden_compensator_f32 in 64-bit words.
#define BOWDEN_COMPENSATOR_F32_WORDS 184

// Size of a bowden_compensator_f64 in 64-bit words.
#define BOWDEN_COMPENSATOR_F64_WORDS 360

// Size of a bowden_edge_velocity_f32 in 64-bit words.
#define BOWDEN_EDGE_VELOCITY_F32_WORDS 8

// Size of a bowden_edge_velocity_f64 in 64-bit words.
#define BOWDEN_EDGE_VELOCITY_F64_WORDS 13

// Size of a bowden_low_pass_f32 in 64-bit words.
#define BOWDEN_LOW_PASS_F32_WORDS 4

// Size of a bowden_low_pass_f64 in 64-bit words.
#define BOWDEN_LOW_PASS_F64_WORDS 6

// Size of a bowden_biquad_f32 in 64-bit words.
#define BOWDEN_BIQUAD_F32_WORDS 8

// Size of a bowden_biquad_f64 in 64-bit words.
#define BOWDEN_BIQUAD_F64_WORDS 14

// Size of a bowden_hysteresis_f32 in 64-bit words.
#define BOWDEN_HYSTERESIS_F32_WORDS 8

// Size of a bowden_hysteresis_f64 in 64-bit words.
#define BOWDEN_HYSTERESIS_F64_WORDS 14

// Size of a bowden_cable_f32 in 64-bit words.
#define BOWDEN_CABLE_F32_WORDS 10

// Size of a bowden_cable_f64 in 64-bit words.
#define BOWDEN_CABLE_F64_WORDS 20

// Size of a bowden_inverse_f32 in 64-bit words.
#define BOWDEN_INVERSE_F32_WORDS 10

// Size of a bowden_inverse_f64 in 64-bit words.
#define BOWDEN_INVERSE_F64_WORDS 20

// Maximum number of cells of a cycle.
#define BOWDEN_CELLS 65535

// Size of a bowden_iterative_learning_f32 in 64-bit words.
#define BOWDEN_ITERATIVE_LEARNING_F32_WORDS 14

// Size of a bowden_iterative_learning_f64 in 64-bit words.
#define BOWDEN_ITERATIVE_LEARNING_F64_WORDS 18

// Maximum number of terms of a model.
#define BOWDEN_TERMS 16

// Maximum number of channels of a sample.
#define BOWDEN_CHANNELS 16

// Maximum number of bytes of a model, which is more than any model with BOWDEN_TERMS terms needs.
#define BOWDEN_MODEL_BYTES 2048

// Size of a bowden_model_f32 in 64-bit words.
#define BOWDEN_MODEL_F32_WORDS 112

// Size of a bowden_model_f64 in 64-bit words.
#define BOWDEN_MODEL_F64_WORDS 216

// Size of a bowden_observer_f32 in 64-bit words.
#define BOWDEN_OBSERVER_F32_WORDS 14

// Size of a bowden_observer_f64 in 64-bit words.
#define BOWDEN_OBSERVER_F64_WORDS 25

// For `after` of a fallback: holds the last good command indefinitely. This is for a simulation,
// not for a machine.
#define BOWDEN_HOLD_FOR_EVER 4294967295

// Size of a bowden_pid_f32 in 64-bit words.
#define BOWDEN_PID_F32_WORDS 24

// Size of a bowden_pid_f64 in 64-bit words.
#define BOWDEN_PID_F64_WORDS 40

// Size of a bowden_plausible_f32 in 64-bit words.
#define BOWDEN_PLAUSIBLE_F32_WORDS 8

// Size of a bowden_plausible_f64 in 64-bit words.
#define BOWDEN_PLAUSIBLE_F64_WORDS 14

// Size of a bowden_play_f32 in 64-bit words.
#define BOWDEN_PLAY_F32_WORDS 4

// Size of a bowden_play_f64 in 64-bit words.
#define BOWDEN_PLAY_F64_WORDS 6

// Size of a bowden_rates_f32 in 64-bit words.
#define BOWDEN_RATES_F32_WORDS 10

// Size of a bowden_rates_f64 in 64-bit words.
#define BOWDEN_RATES_F64_WORDS 16

// Size of a bowden_relay_f32 in 64-bit words.
#define BOWDEN_RELAY_F32_WORDS 26

// Size of a bowden_relay_f64 in 64-bit words.
#define BOWDEN_RELAY_F64_WORDS 44

// Result of a function: 0 for success; above zero if a sample was not good but the output was
// written; below zero if nothing was written.
enum bowden_result
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Success; for a step: a good sample.
    BOWDEN_RESULT_OK = 0,
    // Rates: a good sample, but the rates started from zero less than five time constants ago.
    BOWDEN_RESULT_SETTLING = 1,
    // Rates: a good position after an unknown time; the rates are held.
    BOWDEN_RESULT_RESUMED = 2,
    // A regressor was bad and its term was omitted; the loop is closed, and the estimates do not
    // change. For iterative learning: the feed-forward belongs to this phase, but the error of the
    // sample or of the cell before a jump was ignored.
    BOWDEN_RESULT_DEGRADED = 3,
    // A bad sample: the state is unchanged, and the last good command or value is held.
    BOWDEN_RESULT_HELD = 4,
    // Too many bad samples: the safe command is applied until it is acknowledged.
    BOWDEN_RESULT_SAFE = 5,
    // Velocity from counts: no count for longer than the longest gap, so the velocity is zero.
    BOWDEN_RESULT_STOPPED = 6,
    // The sample is implausible: the value is NaN.
    BOWDEN_RESULT_IMPLAUSIBLE = 7,
    // A pointer is null.
    BOWDEN_RESULT_ERROR_NULL = -1,
    // A pointer is not aligned for its type.
    BOWDEN_RESULT_ERROR_MISALIGNED = -2,
    // The object was not initialised, or it was overwritten.
    BOWDEN_RESULT_ERROR_UNINITIALISED = -3,
    // A setting is NaN or infinite.
    BOWDEN_RESULT_ERROR_NON_FINITE = -4,
    // A setting is outside its range.
    BOWDEN_RESULT_ERROR_OUT_OF_RANGE = -5,
    // Two settings together violate a condition.
    BOWDEN_RESULT_ERROR_INADMISSIBLE = -6,
    // There are more items than the capacity allows.
    BOWDEN_RESULT_ERROR_CAPACITY = -7,
    // A setting has a value that its enum does not contain.
    BOWDEN_RESULT_ERROR_CHOICE = -8,
    // The bytes of a model are damaged, are too many, have the other precision or another version,
    // or contain too many terms.
    BOWDEN_RESULT_ERROR_MODEL = -9,
    // The settings were not initialised with their macro NAME_INIT.
    BOWDEN_RESULT_ERROR_SETTINGS = -10,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_result bowden_result;
#else
typedef int32_t bowden_result;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The bad input of a sample.
enum bowden_fault
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Nothing.
    BOWDEN_FAULT_NONE = 0,
    // dt is NaN or infinite.
    BOWDEN_FAULT_DT = 1,
    // dt is zero or negative: time has not advanced.
    BOWDEN_FAULT_DT_NOT_POSITIVE = 2,
    // dt exceeds the longest dt of the settings, or the stability limit of the law.
    BOWDEN_FAULT_DT_TOO_LONG = 3,
    // The reference, or its next value.
    BOWDEN_FAULT_REFERENCE = 4,
    // The measured output.
    BOWDEN_FAULT_MEASURED = 5,
    // The measured velocity.
    BOWDEN_FAULT_VELOCITY = 6,
    // The feed-forward command.
    BOWDEN_FAULT_FEED_FORWARD = 7,
    // The command to resume from.
    BOWDEN_FAULT_COMMAND = 8,
    // A regressor, or an input of a model's term; its index is in the output.
    BOWDEN_FAULT_REGRESSOR = 9,
    // Every input is finite, but the command could not be computed: an overflow.
    BOWDEN_FAULT_OVERFLOW = 10,
    // The position.
    BOWDEN_FAULT_POSITION = 11,
    // A fault from a later version.
    BOWDEN_FAULT_OTHER = 12,
    // The phase of a cycle is outside 0 to 1, or has jumped.
    BOWDEN_FAULT_PHASE = 13,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_fault bowden_fault;
#else
typedef int32_t bowden_fault;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Why a sample is implausible.
enum bowden_implausible
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The sample is plausible.
    BOWDEN_IMPLAUSIBLE_NONE = 0,
    // It is NaN or infinite.
    BOWDEN_IMPLAUSIBLE_NOT_FINITE = 1,
    // It lies outside the range.
    BOWDEN_IMPLAUSIBLE_OUT_OF_RANGE = 2,
    // It is further from the last plausible sample than the rate allows.
    BOWDEN_IMPLAUSIBLE_TOO_FAST = 3,
    // It has kept the same value for too long while the machine moved.
    BOWDEN_IMPLAUSIBLE_STUCK = 4,
    // A reason from a later version.
    BOWDEN_IMPLAUSIBLE_OTHER = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_implausible bowden_implausible;
#else
typedef int32_t bowden_implausible;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Phase of a relay experiment.
enum bowden_relay_phase
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The relay switches; after a bad sample the command is held.
    BOWDEN_RELAY_PHASE_RUNNING = 0,
    // The experiment has succeeded: the relay applies the centre.
    BOWDEN_RELAY_PHASE_DONE = 1,
    // The experiment has failed: the safe command is applied until bowden_relay_acknowledge.
    BOWDEN_RELAY_PHASE_FAILED = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_relay_phase bowden_relay_phase;
#else
typedef int32_t bowden_relay_phase;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Why a relay experiment failed.
enum bowden_relay_failure
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The experiment has not failed.
    BOWDEN_RELAY_FAILURE_NONE = 0,
    // Too many bad samples; the fault is that of the last one.
    BOWDEN_RELAY_FAILURE_BAD_SAMPLES = 1,
    // The output was further from the reference than `most_deviation`: choose a smaller
    // amplitude, a centre that holds the reference, or the other sign of the amplitude.
    BOWDEN_RELAY_FAILURE_OUTPUT_OUT_OF_RANGE = 2,
    // `longest_time` has passed without a complete cycle: the amplitude does not move the output
    // through the reference, its sign is wrong, or the time is too short for two periods.
    BOWDEN_RELAY_FAILURE_NO_OSCILLATION = 3,
    // `longest_time` has passed and the cycles did not agree: the time is too short, the noise
    // exceeds the hysteresis, or a cycle has fewer than 2/agreement samples.
    BOWDEN_RELAY_FAILURE_TIME_OUT = 4,
    // A reason from a later version.
    BOWDEN_RELAY_FAILURE_OTHER = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_relay_failure bowden_relay_failure;
#else
typedef int32_t bowden_relay_failure;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The signal that the gain `k_d` multiplies.
enum bowden_derivative_source
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The filtered derivative of y - c*y_r, PID (14).
    BOWDEN_DERIVATIVE_SOURCE_RATE = 0,
    // The measured distal velocity, unfiltered, PIV (16).
    BOWDEN_DERIVATIVE_SOURCE_VELOCITY = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_derivative_source bowden_derivative_source;
#else
typedef uint32_t bowden_derivative_source;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Anti-windup: limits the integral while the command is limited.
enum bowden_anti_windup
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A change of the integral that would take the command beyond its range is cut to the value
    // that fills the range; a change away from the limit acts in full.
    BOWDEN_ANTI_WINDUP_CONDITIONAL = 0,
    // No anti-windup: the integral winds up.
    BOWDEN_ANTI_WINDUP_NONE = 1,
    // The integral term stays within the range of the command, widened to include zero.
    BOWDEN_ANTI_WINDUP_CLAMP = 2,
    // The part that the limits cut off returns to the integral with the time constant
    // `tracking_time`.
    BOWDEN_ANTI_WINDUP_BACK_CALCULATION = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_anti_windup bowden_anti_windup;
#else
typedef uint32_t bowden_anti_windup;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Input and output quantities.
enum bowden_mode
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Torque to torque, (5): y = gain*u - kappa_eta*eta - offset.
    BOWDEN_MODE_TORQUE = 0,
    // Displacement to force, (1): y = gain*u + kappa_eta*eta + offset.
    BOWDEN_MODE_DISPLACEMENT = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_mode bowden_mode;
#else
typedef uint32_t bowden_mode;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Treatment of the error's rate in the law: each form is for one kind of plant.
enum bowden_form
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // (23) as published, with a filtered difference of the error: for a plant with inertia.
    BOWDEN_FORM_AS_PUBLISHED = 0,
    // The law solved for the error's rate: for a plant that responds within a sample.
    BOWDEN_FORM_FIRST_ORDER = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_form bowden_form;
#else
typedef uint32_t bowden_form;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The smooth sign in (23) and (25).
enum bowden_smooth_sign
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // tanh(x), as in the paper.
    BOWDEN_SMOOTH_SIGN_TANH = 0,
    // x within [-1, 1]: cheaper, with a smaller residual.
    BOWDEN_SMOOTH_SIGN_CLAMP = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_smooth_sign bowden_smooth_sign;
#else
typedef uint32_t bowden_smooth_sign;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Leakage of an estimate to its prior.
enum bowden_leakage
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // No leakage: only the bounds limit the estimate.
    BOWDEN_LEAKAGE_NONE = 0,
    // Leakage at `leakage_rate` at all times: the sigma of (24)-(26).
    BOWDEN_LEAKAGE_CONSTANT = 1,
    // Leakage only if the estimate is further than `leakage_bound` from its prior; the rate
    // reaches `leakage_rate` at twice this distance.
    BOWDEN_LEAKAGE_SWITCHING = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_leakage bowden_leakage;
#else
typedef uint32_t bowden_leakage;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Response to a regressor that is not finite.
enum bowden_on_missing
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A bad sample: the command is held.
    BOWDEN_ON_MISSING_HOLD = 0,
    // Its term is omitted, the estimates do not change, and the loop stays closed:
    // BOWDEN_RESULT_DEGRADED.
    BOWDEN_ON_MISSING_DROP_REGRESSOR = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_on_missing bowden_on_missing;
#else
typedef uint32_t bowden_on_missing;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The active limit of a command or a drive.
enum bowden_saturation
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // No limit: the command was applied.
    BOWDEN_SATURATION_NONE = 0,
    // The applied command is below the law's command.
    BOWDEN_SATURATION_UPPER = 1,
    // The applied command is above the law's command.
    BOWDEN_SATURATION_LOWER = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_saturation bowden_saturation;
#else
typedef uint32_t bowden_saturation;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Tuning rule: PI gains from ultimate gain and period.
enum bowden_pi_rule
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // k_p = gain/3.2, k_i = k_p/(2.2*period): the conservative rule.
    BOWDEN_PI_RULE_TYREUS_LUYBEN = 0,
    // k_p = 0.45*gain, k_i = k_p/(period/1.2): fast, with an overshoot.
    BOWDEN_PI_RULE_ZIEGLER_NICHOLS = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_pi_rule bowden_pi_rule;
#else
typedef uint32_t bowden_pi_rule;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// An adaptive law with its state, in the caller's memory; initialised by
// bowden_adaptive_init.
typedef struct bowden_adaptive_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_ADAPTIVE_F32_WORDS];
} bowden_adaptive_f32;

// How one estimate adapts, (24)-(26), with its bounds.
//
// Start from NAME_INIT, as the estimates in the settings of the law do. By default the
// estimate is fixed at 0, with a gain of 0 and no leakage.
typedef struct bowden_estimator_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Initial value of the estimate [unit of the estimate], within its bounds.
    float initial;
    // Least value [unit of the estimate].
    float low;
    // Greatest value [unit of the estimate].
    float high;
    // Adaptation gain: gamma, mu or mu_i of (24)-(26), not negative.
    float gain;
    // Prior, the target of the leakage [unit of the estimate]; 0 in the paper.
    float prior;
    // One of bowden_leakage.
    uint32_t leakage;
    // Greatest leakage, not negative [1/s].
    float leakage_rate;
    // Distance from the prior without leakage, for BOWDEN_LEAKAGE_SWITCHING only;
    // above zero [unit of the estimate].
    float leakage_bound;
} bowden_estimator_f32;

// The defaults, in C99 and C++11:
//
//     bowden_estimator_f32 settings = BOWDEN_ESTIMATOR_F32_INIT;
#define BOWDEN_ESTIMATOR_F32_INIT { \
    1679694325u, /* init_mark */ \
    0.0f, /* initial */ \
    0.0f, /* low */ \
    0.0f, /* high */ \
    0.0f, /* gain */ \
    0.0f, /* prior */ \
    0u, /* leakage */ \
    0.0f, /* leakage_rate */ \
    0.0f /* leakage_bound */ \
}

// Range and slew-rate limit of a command.
typedef struct bowden_limits_f32 {
    // Least command [command unit].
    float low;
    // Greatest command [command unit]; above `low`.
    float high;
    // Slew-rate limit, above zero [command unit/s]; 0 for none.
    float slew;
} bowden_limits_f32;

// The safe command after repeated bad samples.
//
// A score counts the bad samples: a bad sample adds the weight, and a good sample
// subtracts 1. At after*weight the safe command is applied until it is acknowledged.
typedef struct bowden_fallback_f32 {
    // Number of bad samples in a row after which the safe command is applied, at least
    // 1; BOWDEN_HOLD_FOR_EVER for never.
    uint32_t after;
    // Number of good samples that cancel a bad one, at least 1; 4 is usual.
    uint32_t weight;
    // The safe command [command unit], within the limits.
    float command;
} bowden_fallback_f32;

// Settings of the adaptive law, (17)-(26).
//
// Start from NAME_INIT. By default: no regressors; k, lambda and epsilon of the paper;
// 5 ms for the form as published; beta_hat fixed at 1, delta_hat and theta_hat at 0;
// tanh; no limit of z; no slew-rate limit; 4 good samples to cancel a bad one; and a
// safe command of 0. These fields must be set: the form (for the first-order form also
// step and plant_gain), limits, longest_dt and `after`.
typedef struct bowden_adaptive_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // One of bowden_form.
    uint32_t form;
    // Form as published: time constant of the filter of the error's rate, 2 to 20 ms
    // [s].
    float time_constant;
    // First-order form, required: longest intended sample time [s].
    float step;
    // First-order form: upper bound on the plant's gain alpha [N*m/command unit].
    float plant_gain;
    // Control gain k, above zero.
    float gain;
    // lambda, above zero [1/s]: weight of the accumulated error, (18).
    float lambda;
    // epsilon, above zero [N*m]: width of the smooth sign.
    float epsilon;
    // One of bowden_smooth_sign.
    uint32_t smooth_sign;
    // Estimate of 1/alpha [command unit/(N*m)], (24).
    struct bowden_estimator_f32 beta;
    // Estimate of the bound on the disturbance [N*m], (25).
    struct bowden_estimator_f32 delta;
    // Number of regressors, at most BOWDEN_REGRESSORS.
    uint32_t regressors;
    // Estimates of theta_i [N*m/unit of the regressor], (26); those from index
    // `regressors` on are ignored.
    struct bowden_estimator_f32 theta[BOWDEN_REGRESSORS];
    // One of bowden_on_missing for each regressor.
    uint32_t missing[BOWDEN_REGRESSORS];
    // Greatest magnitude of the accumulated error z, above zero [N*m*s].
    float z_limit;
    // Normally 0; any other value freezes the estimates.
    uint32_t frozen;
    // Range and slew-rate limit of the command.
    struct bowden_limits_f32 limits;
    // Longest dt of a good sample, above zero [s]; the first-order form also rejects a
    // dt longer than 1/(lambda*max(1, g*(k + delta.high/epsilon))).
    float longest_dt;
    // Fallback after repeated bad samples.
    struct bowden_fallback_f32 fallback;
} bowden_adaptive_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_adaptive_settings_f32 settings = BOWDEN_ADAPTIVE_SETTINGS_F32_INIT;
#define BOWDEN_ADAPTIVE_SETTINGS_F32_INIT { \
    529839157u, /* init_mark */ \
    4294967295u, /* form */ \
    0.005f, /* time_constant */ \
    0.0f, /* step */ \
    0.0f, /* plant_gain */ \
    24.0f, /* gain */ \
    8.0f, /* lambda */ \
    0.05f, /* epsilon */ \
    0u, /* smooth_sign */ \
    {1679694325u, 1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0u, 0.0f, 0.0f}, /* beta */ \
    {1679694325u, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u, 0.0f, 0.0f}, /* delta */ \
    0u, /* regressors */ \
    {{1679694325u, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u, 0.0f, 0.0f}, {1679694325u, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u, 0.0f, 0.0f}, {1679694325u, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u, 0.0f, 0.0f}, {1679694325u, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u, 0.0f, 0.0f}}, /* theta */ \
    {0u, 0u, 0u, 0u}, /* missing */ \
    3.4028235e38f, /* z_limit */ \
    0u, /* frozen */ \
    {3.4028235e38f, -3.4028235e38f, 0.0f}, /* limits */ \
    0.0f, /* longest_dt */ \
    {0u, 4u, 0.0f} /* fallback */ \
}

// The name of the refused setting, or the violated condition.
typedef struct bowden_about {
    // ASCII with a NUL at the end, such as "k_p" or "low < high"; truncated if it is longer.
    char text[128];
} bowden_about;

// One sample for the adaptive law.
typedef struct bowden_adaptive_sample_f32 {
    // Time since the last call [s], also after a bad sample.
    float dt;
    // Reference y_r [N*m].
    float reference;
    // Reference at the next sample [N*m]; only the first-order form reads it.
    float next_reference;
    // Measured output torque y [N*m].
    float measured;
    // Regressors x_i [their own units]: velocity and acceleration in the paper. The
    // law ignores regressors beyond the number in its settings.
    float regressors[BOWDEN_REGRESSORS];
    // Feed-forward, added to the law's command [command unit]; 0 for none.
    float feed_forward;
} bowden_adaptive_sample_f32;

// Output of a step of a controller.
typedef struct bowden_output_f32 {
    // Command for the drive [command unit]: finite and within the limits.
    float command;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
    // Index of the regressor or term, from 0, if the fault is BOWDEN_FAULT_REGRESSOR.
    uint32_t regressor;
} bowden_output_f32;

// The estimates of the law.
typedef struct bowden_estimates_f32 {
    // Accumulated error z [N*m*s], (17).
    float z;
    // beta_hat [command unit/(N*m)].
    float beta;
    // delta_hat [N*m].
    float delta;
    // theta_hat_i [N*m/unit of the regressor].
    float theta[BOWDEN_REGRESSORS];
} bowden_estimates_f32;

// An adaptive law with its state, in the caller's memory; initialised by
// bowden_adaptive_init.
typedef struct bowden_adaptive_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_ADAPTIVE_F64_WORDS];
} bowden_adaptive_f64;

// How one estimate adapts, (24)-(26), with its bounds.
//
// Start from NAME_INIT, as the estimates in the settings of the law do. By default the
// estimate is fixed at 0, with a gain of 0 and no leakage.
typedef struct bowden_estimator_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Initial value of the estimate [unit of the estimate], within its bounds.
    double initial;
    // Least value [unit of the estimate].
    double low;
    // Greatest value [unit of the estimate].
    double high;
    // Adaptation gain: gamma, mu or mu_i of (24)-(26), not negative.
    double gain;
    // Prior, the target of the leakage [unit of the estimate]; 0 in the paper.
    double prior;
    // One of bowden_leakage.
    uint32_t leakage;
    // Greatest leakage, not negative [1/s].
    double leakage_rate;
    // Distance from the prior without leakage, for BOWDEN_LEAKAGE_SWITCHING only;
    // above zero [unit of the estimate].
    double leakage_bound;
} bowden_estimator_f64;

// The defaults, in C99 and C++11:
//
//     bowden_estimator_f64 settings = BOWDEN_ESTIMATOR_F64_INIT;
#define BOWDEN_ESTIMATOR_F64_INIT { \
    4027205765u, /* init_mark */ \
    0.0, /* initial */ \
    0.0, /* low */ \
    0.0, /* high */ \
    0.0, /* gain */ \
    0.0, /* prior */ \
    0u, /* leakage */ \
    0.0, /* leakage_rate */ \
    0.0 /* leakage_bound */ \
}

// Range and slew-rate limit of a command.
typedef struct bowden_limits_f64 {
    // Least command [command unit].
    double low;
    // Greatest command [command unit]; above `low`.
    double high;
    // Slew-rate limit, above zero [command unit/s]; 0 for none.
    double slew;
} bowden_limits_f64;

// The safe command after repeated bad samples.
//
// A score counts the bad samples: a bad sample adds the weight, and a good sample
// subtracts 1. At after*weight the safe command is applied until it is acknowledged.
typedef struct bowden_fallback_f64 {
    // Number of bad samples in a row after which the safe command is applied, at least
    // 1; BOWDEN_HOLD_FOR_EVER for never.
    uint32_t after;
    // Number of good samples that cancel a bad one, at least 1; 4 is usual.
    uint32_t weight;
    // The safe command [command unit], within the limits.
    double command;
} bowden_fallback_f64;

// Settings of the adaptive law, (17)-(26).
//
// Start from NAME_INIT. By default: no regressors; k, lambda and epsilon of the paper;
// 5 ms for the form as published; beta_hat fixed at 1, delta_hat and theta_hat at 0;
// tanh; no limit of z; no slew-rate limit; 4 good samples to cancel a bad one; and a
// safe command of 0. These fields must be set: the form (for the first-order form also
// step and plant_gain), limits, longest_dt and `after`.
typedef struct bowden_adaptive_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // One of bowden_form.
    uint32_t form;
    // Form as published: time constant of the filter of the error's rate, 2 to 20 ms
    // [s].
    double time_constant;
    // First-order form, required: longest intended sample time [s].
    double step;
    // First-order form: upper bound on the plant's gain alpha [N*m/command unit].
    double plant_gain;
    // Control gain k, above zero.
    double gain;
    // lambda, above zero [1/s]: weight of the accumulated error, (18).
    double lambda;
    // epsilon, above zero [N*m]: width of the smooth sign.
    double epsilon;
    // One of bowden_smooth_sign.
    uint32_t smooth_sign;
    // Estimate of 1/alpha [command unit/(N*m)], (24).
    struct bowden_estimator_f64 beta;
    // Estimate of the bound on the disturbance [N*m], (25).
    struct bowden_estimator_f64 delta;
    // Number of regressors, at most BOWDEN_REGRESSORS.
    uint32_t regressors;
    // Estimates of theta_i [N*m/unit of the regressor], (26); those from index
    // `regressors` on are ignored.
    struct bowden_estimator_f64 theta[BOWDEN_REGRESSORS];
    // One of bowden_on_missing for each regressor.
    uint32_t missing[BOWDEN_REGRESSORS];
    // Greatest magnitude of the accumulated error z, above zero [N*m*s].
    double z_limit;
    // Normally 0; any other value freezes the estimates.
    uint32_t frozen;
    // Range and slew-rate limit of the command.
    struct bowden_limits_f64 limits;
    // Longest dt of a good sample, above zero [s]; the first-order form also rejects a
    // dt longer than 1/(lambda*max(1, g*(k + delta.high/epsilon))).
    double longest_dt;
    // Fallback after repeated bad samples.
    struct bowden_fallback_f64 fallback;
} bowden_adaptive_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_adaptive_settings_f64 settings = BOWDEN_ADAPTIVE_SETTINGS_F64_INIT;
#define BOWDEN_ADAPTIVE_SETTINGS_F64_INIT { \
    2340480325u, /* init_mark */ \
    4294967295u, /* form */ \
    0.005, /* time_constant */ \
    0.0, /* step */ \
    0.0, /* plant_gain */ \
    24.0, /* gain */ \
    8.0, /* lambda */ \
    0.05, /* epsilon */ \
    0u, /* smooth_sign */ \
    {4027205765u, 1.0, 1.0, 1.0, 0.0, 0.0, 0u, 0.0, 0.0}, /* beta */ \
    {4027205765u, 0.0, 0.0, 0.0, 0.0, 0.0, 0u, 0.0, 0.0}, /* delta */ \
    0u, /* regressors */ \
    {{4027205765u, 0.0, 0.0, 0.0, 0.0, 0.0, 0u, 0.0, 0.0}, {4027205765u, 0.0, 0.0, 0.0, 0.0, 0.0, 0u, 0.0, 0.0}, {4027205765u, 0.0, 0.0, 0.0, 0.0, 0.0, 0u, 0.0, 0.0}, {4027205765u, 0.0, 0.0, 0.0, 0.0, 0.0, 0u, 0.0, 0.0}}, /* theta */ \
    {0u, 0u, 0u, 0u}, /* missing */ \
    1.7976931348623157e308, /* z_limit */ \
    0u, /* frozen */ \
    {1.7976931348623157e308, -1.7976931348623157e308, 0.0}, /* limits */ \
    0.0, /* longest_dt */ \
    {0u, 4u, 0.0} /* fallback */ \
}

// One sample for the adaptive law.
typedef struct bowden_adaptive_sample_f64 {
    // Time since the last call [s], also after a bad sample.
    double dt;
    // Reference y_r [N*m].
    double reference;
    // Reference at the next sample [N*m]; only the first-order form reads it.
    double next_reference;
    // Measured output torque y [N*m].
    double measured;
    // Regressors x_i [their own units]: velocity and acceleration in the paper. The
    // law ignores regressors beyond the number in its settings.
    double regressors[BOWDEN_REGRESSORS];
    // Feed-forward, added to the law's command [command unit]; 0 for none.
    double feed_forward;
} bowden_adaptive_sample_f64;

// Output of a step of a controller.
typedef struct bowden_output_f64 {
    // Command for the drive [command unit]: finite and within the limits.
    double command;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
    // Index of the regressor or term, from 0, if the fault is BOWDEN_FAULT_REGRESSOR.
    uint32_t regressor;
} bowden_output_f64;

// The estimates of the law.
typedef struct bowden_estimates_f64 {
    // Accumulated error z [N*m*s], (17).
    double z;
    // beta_hat [command unit/(N*m)].
    double beta;
    // delta_hat [N*m].
    double delta;
    // theta_hat_i [N*m/unit of the regressor].
    double theta[BOWDEN_REGRESSORS];
} bowden_estimates_f64;

// An inverted model with its state, in the caller's memory; initialised by
// bowden_compensator_init.
typedef struct bowden_compensator_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_COMPENSATOR_F32_WORDS];
} bowden_compensator_f32;

// An identified model with its state, in the caller's memory; initialised by
// bowden_model_load.
typedef struct bowden_model_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_MODEL_F32_WORDS];
} bowden_model_f32;

// Position, velocity and acceleration of one channel, in its own units and seconds.
typedef struct bowden_motion_f32 {
    // Position [channel unit].
    float position;
    // Velocity [channel unit/s].
    float velocity;
    // Acceleration [channel unit/s^2].
    float acceleration;
} bowden_motion_f32;

// Range of one source in the bench record: the effects do not extrapolate beyond it.
typedef struct bowden_range_f32 {
    // The channel, from 0, or BOWDEN_SOURCE_INPUT.
    uint32_t source;
    // Least position, velocity and acceleration.
    struct bowden_motion_f32 low;
    // Greatest position, velocity and acceleration.
    struct bowden_motion_f32 high;
} bowden_range_f32;

// One sample for a compensator.
typedef struct bowden_compensator_sample_f32 {
    // Time since the previous sample, above zero [s].
    float dt;
    // Desired output [output unit], such as tau_o [N*m]: the reference, not the
    // measured output.
    float desired;
    // The present input of the transmission with its rates, for effects that read it.
    struct bowden_motion_f32 input;
    // The transmitted load: tau_i in torque mode, otherwise a load channel.
    float load;
    // All other channels, in the order in the model's file; may be null if there are
    // none.
    const struct bowden_motion_f32 *channels;
    // Number of channels, at most BOWDEN_CHANNELS.
    size_t channel_count;
} bowden_compensator_sample_f32;

// Output of a step of a compensator.
typedef struct bowden_compensator_output_f32 {
    // The transmission's input [input unit], such as tau_i [N*m]; finite.
    float command;
    // Share of the effects in the output [output unit], zero on a bad sample.
    float effects;
    // The model's hysteresis state, within -1 and 1.
    float eta;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
    // Index of the term, from 0, if the fault is BOWDEN_FAULT_REGRESSOR.
    uint32_t regressor;
} bowden_compensator_output_f32;

// An inverted model with its state, in the caller's memory; initialised by
// bowden_compensator_init.
typedef struct bowden_compensator_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_COMPENSATOR_F64_WORDS];
} bowden_compensator_f64;

// An identified model with its state, in the caller's memory; initialised by
// bowden_model_load.
typedef struct bowden_model_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_MODEL_F64_WORDS];
} bowden_model_f64;

// Position, velocity and acceleration of one channel, in its own units and seconds.
typedef struct bowden_motion_f64 {
    // Position [channel unit].
    double position;
    // Velocity [channel unit/s].
    double velocity;
    // Acceleration [channel unit/s^2].
    double acceleration;
} bowden_motion_f64;

// Range of one source in the bench record: the effects do not extrapolate beyond it.
typedef struct bowden_range_f64 {
    // The channel, from 0, or BOWDEN_SOURCE_INPUT.
    uint32_t source;
    // Least position, velocity and acceleration.
    struct bowden_motion_f64 low;
    // Greatest position, velocity and acceleration.
    struct bowden_motion_f64 high;
} bowden_range_f64;

// One sample for a compensator.
typedef struct bowden_compensator_sample_f64 {
    // Time since the previous sample, above zero [s].
    double dt;
    // Desired output [output unit], such as tau_o [N*m]: the reference, not the
    // measured output.
    double desired;
    // The present input of the transmission with its rates, for effects that read it.
    struct bowden_motion_f64 input;
    // The transmitted load: tau_i in torque mode, otherwise a load channel.
    double load;
    // All other channels, in the order in the model's file; may be null if there are
    // none.
    const struct bowden_motion_f64 *channels;
    // Number of channels, at most BOWDEN_CHANNELS.
    size_t channel_count;
} bowden_compensator_sample_f64;

// Output of a step of a compensator.
typedef struct bowden_compensator_output_f64 {
    // The transmission's input [input unit], such as tau_i [N*m]; finite.
    double command;
    // Share of the effects in the output [output unit], zero on a bad sample.
    double effects;
    // The model's hysteresis state, within -1 and 1.
    double eta;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
    // Index of the term, from 0, if the fault is BOWDEN_FAULT_REGRESSOR.
    uint32_t regressor;
} bowden_compensator_output_f64;

// A velocity from counts with its state; initialised by bowden_edge_velocity_init.
typedef struct bowden_edge_velocity_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_EDGE_VELOCITY_F32_WORDS];
} bowden_edge_velocity_f32;

// Settings of a velocity from the time between counts, see bowden_edge_velocity_step.
//
// Start from NAME_INIT. By default the position does not wrap; all other fields must be
// set.
typedef struct bowden_edge_velocity_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Size of one count, above zero [channel unit]: positions change by multiples of
    // it.
    float count;
    // Counts that come faster than this time are averaged, above zero [s].
    float time_constant;
    // After this time without a count the velocity is zero, above zero [s]. A speed
    // below count/longest_gap reads as zero.
    float longest_gap;
    // Period of a position that wraps, such as a counter's, above zero [channel unit];
    // 0 for none.
    float period;
} bowden_edge_velocity_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_edge_velocity_settings_f32 settings = BOWDEN_EDGE_VELOCITY_SETTINGS_F32_INIT;
#define BOWDEN_EDGE_VELOCITY_SETTINGS_F32_INIT { \
    4126558932u, /* init_mark */ \
    0.0f, /* count */ \
    0.0f, /* time_constant */ \
    0.0f, /* longest_gap */ \
    0.0f /* period */ \
}

// Output of a step of a velocity from counts.
typedef struct bowden_edge_velocity_output_f32 {
    // Velocity [channel unit/s]: finite, and zero until two counts are known.
    float velocity;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
} bowden_edge_velocity_output_f32;

// A velocity from counts with its state; initialised by bowden_edge_velocity_init.
typedef struct bowden_edge_velocity_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_EDGE_VELOCITY_F64_WORDS];
} bowden_edge_velocity_f64;

// Settings of a velocity from the time between counts, see bowden_edge_velocity_step.
//
// Start from NAME_INIT. By default the position does not wrap; all other fields must be
// set.
typedef struct bowden_edge_velocity_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Size of one count, above zero [channel unit]: positions change by multiples of
    // it.
    double count;
    // Counts that come faster than this time are averaged, above zero [s].
    double time_constant;
    // After this time without a count the velocity is zero, above zero [s]. A speed
    // below count/longest_gap reads as zero.
    double longest_gap;
    // Period of a position that wraps, such as a counter's, above zero [channel unit];
    // 0 for none.
    double period;
} bowden_edge_velocity_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_edge_velocity_settings_f64 settings = BOWDEN_EDGE_VELOCITY_SETTINGS_F64_INIT;
#define BOWDEN_EDGE_VELOCITY_SETTINGS_F64_INIT { \
    1642208164u, /* init_mark */ \
    0.0, /* count */ \
    0.0, /* time_constant */ \
    0.0, /* longest_gap */ \
    0.0 /* period */ \
}

// Output of a step of a velocity from counts.
typedef struct bowden_edge_velocity_output_f64 {
    // Velocity [channel unit/s]: finite, and zero until two counts are known.
    double velocity;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
} bowden_edge_velocity_output_f64;

// A first-order low-pass with its state; initialised by bowden_low_pass_init.
typedef struct bowden_low_pass_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_LOW_PASS_F32_WORDS];
} bowden_low_pass_f32;

// A second-order filter with its state; initialised by bowden_biquad_init_low_pass or
// bowden_biquad_init_notch.
typedef struct bowden_biquad_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_BIQUAD_F32_WORDS];
} bowden_biquad_f32;

// Settings of a second-order low-pass or notch, with s in units of 2*pi*frequency:
//
//     low-pass  1/(s^2 + s/q + 1)
//     notch     (s^2 + 1)/(s^2 + s/q + 1)
//
// Start from NAME_INIT; all fields must be set.
typedef struct bowden_biquad_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Corner of the low-pass or centre of the notch, above zero and below
    // 1/(2*sample_time) [Hz].
    float frequency;
    // Quality factor, above zero. Low-pass: 0.7071 for Butterworth, 0.5 for critical
    // damping. Notch: its width at -3 dB is frequency/q [Hz].
    float q;
    // Nominal sample time, above zero [s].
    float sample_time;
} bowden_biquad_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_biquad_settings_f32 settings = BOWDEN_BIQUAD_SETTINGS_F32_INIT;
#define BOWDEN_BIQUAD_SETTINGS_F32_INIT { \
    3823831408u, /* init_mark */ \
    0.0f, /* frequency */ \
    0.0f, /* q */ \
    0.0f /* sample_time */ \
}

// A first-order low-pass with its state; initialised by bowden_low_pass_init.
typedef struct bowden_low_pass_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_LOW_PASS_F64_WORDS];
} bowden_low_pass_f64;

// A second-order filter with its state; initialised by bowden_biquad_init_low_pass or
// bowden_biquad_init_notch.
typedef struct bowden_biquad_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_BIQUAD_F64_WORDS];
} bowden_biquad_f64;

// Settings of a second-order low-pass or notch, with s in units of 2*pi*frequency:
//
//     low-pass  1/(s^2 + s/q + 1)
//     notch     (s^2 + 1)/(s^2 + s/q + 1)
//
// Start from NAME_INIT; all fields must be set.
typedef struct bowden_biquad_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Corner of the low-pass or centre of the notch, above zero and below
    // 1/(2*sample_time) [Hz].
    double frequency;
    // Quality factor, above zero. Low-pass: 0.7071 for Butterworth, 0.5 for critical
    // damping. Notch: its width at -3 dB is frequency/q [Hz].
    double q;
    // Nominal sample time, above zero [s].
    double sample_time;
} bowden_biquad_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_biquad_settings_f64 settings = BOWDEN_BIQUAD_SETTINGS_F64_INIT;
#define BOWDEN_BIQUAD_SETTINGS_F64_INIT { \
    2013222912u, /* init_mark */ \
    0.0, /* frequency */ \
    0.0, /* q */ \
    0.0 /* sample_time */ \
}

// The hysteresis (2), (7) with its state; initialised by bowden_hysteresis_init.
typedef struct bowden_hysteresis_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_HYSTERESIS_F32_WORDS];
} bowden_hysteresis_f32;

// Settings of a hysteresis (2), (7).
//
// Start from NAME_INIT. By default eta is 0; all other fields must be set.
typedef struct bowden_hysteresis_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // rho, the initial slope of eta; above zero [1/input unit].
    float rho;
    // sigma, at least 1/2: the slope after a reversal is 2*sigma*rho.
    float sigma;
    // n, the sharpness of the knee; at least 1.
    float n;
    // The hysteresis state at the start, within -1 and 1; 0 if unknown.
    float eta;
} bowden_hysteresis_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_hysteresis_settings_f32 settings = BOWDEN_HYSTERESIS_SETTINGS_F32_INIT;
#define BOWDEN_HYSTERESIS_SETTINGS_F32_INIT { \
    3187750180u, /* init_mark */ \
    0.0f, /* rho */ \
    0.0f, /* sigma */ \
    0.0f, /* n */ \
    0.0f /* eta */ \
}

// A transmission (1), (5) with its state; initialised by bowden_cable_init.
typedef struct bowden_cable_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_CABLE_F32_WORDS];
} bowden_cable_f32;

// Parameters of the transmission, (1), (2), (5) and (7).
//
// Start from NAME_INIT. By default offset and eta are 0; all other fields must be set.
typedef struct bowden_cable_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // One of bowden_mode.
    uint32_t mode;
    // B of (5) or kappa of (1) [output unit/input unit].
    float gain;
    // Gain of the hysteresis [output unit].
    float kappa_eta;
    // T0 of (5) or the offset of (1) [output unit]; 0 by default.
    float offset;
    // rho, the initial slope of eta; above zero [1/input unit].
    float rho;
    // sigma, at least 1/2: the slope after a reversal is 2*sigma*rho.
    float sigma;
    // n, the sharpness of the knee; at least 1.
    float n;
    // The hysteresis state at the start, within -1 and 1; 0 if unknown.
    float eta;
} bowden_cable_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_cable_settings_f32 settings = BOWDEN_CABLE_SETTINGS_F32_INIT;
#define BOWDEN_CABLE_SETTINGS_F32_INIT { \
    4164840447u, /* init_mark */ \
    4294967295u, /* mode */ \
    3.4028235e38f, /* gain */ \
    3.4028235e38f, /* kappa_eta */ \
    0.0f, /* offset */ \
    0.0f, /* rho */ \
    0.0f, /* sigma */ \
    0.0f, /* n */ \
    0.0f /* eta */ \
}

// The inverse (6) of a transmission, with its state; initialised by
// bowden_inverse_init.
typedef struct bowden_inverse_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_INVERSE_F32_WORDS];
} bowden_inverse_f32;

// The hysteresis (2), (7) with its state; initialised by bowden_hysteresis_init.
typedef struct bowden_hysteresis_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_HYSTERESIS_F64_WORDS];
} bowden_hysteresis_f64;

// Settings of a hysteresis (2), (7).
//
// Start from NAME_INIT. By default eta is 0; all other fields must be set.
typedef struct bowden_hysteresis_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // rho, the initial slope of eta; above zero [1/input unit].
    double rho;
    // sigma, at least 1/2: the slope after a reversal is 2*sigma*rho.
    double sigma;
    // n, the sharpness of the knee; at least 1.
    double n;
    // The hysteresis state at the start, within -1 and 1; 0 if unknown.
    double eta;
} bowden_hysteresis_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_hysteresis_settings_f64 settings = BOWDEN_HYSTERESIS_SETTINGS_F64_INIT;
#define BOWDEN_HYSTERESIS_SETTINGS_F64_INIT { \
    706045012u, /* init_mark */ \
    0.0, /* rho */ \
    0.0, /* sigma */ \
    0.0, /* n */ \
    0.0 /* eta */ \
}

// A transmission (1), (5) with its state; initialised by bowden_cable_init.
typedef struct bowden_cable_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_CABLE_F64_WORDS];
} bowden_cable_f64;

// Parameters of the transmission, (1), (2), (5) and (7).
//
// Start from NAME_INIT. By default offset and eta are 0; all other fields must be set.
typedef struct bowden_cable_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // One of bowden_mode.
    uint32_t mode;
    // B of (5) or kappa of (1) [output unit/input unit].
    double gain;
    // Gain of the hysteresis [output unit].
    double kappa_eta;
    // T0 of (5) or the offset of (1) [output unit]; 0 by default.
    double offset;
    // rho, the initial slope of eta; above zero [1/input unit].
    double rho;
    // sigma, at least 1/2: the slope after a reversal is 2*sigma*rho.
    double sigma;
    // n, the sharpness of the knee; at least 1.
    double n;
    // The hysteresis state at the start, within -1 and 1; 0 if unknown.
    double eta;
} bowden_cable_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_cable_settings_f64 settings = BOWDEN_CABLE_SETTINGS_F64_INIT;
#define BOWDEN_CABLE_SETTINGS_F64_INIT { \
    1814706831u, /* init_mark */ \
    4294967295u, /* mode */ \
    1.7976931348623157e308, /* gain */ \
    1.7976931348623157e308, /* kappa_eta */ \
    0.0, /* offset */ \
    0.0, /* rho */ \
    0.0, /* sigma */ \
    0.0, /* n */ \
    0.0 /* eta */ \
}

// The inverse (6) of a transmission, with its state; initialised by
// bowden_inverse_init.
typedef struct bowden_inverse_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_INVERSE_F64_WORDS];
} bowden_inverse_f64;

// Iterative learning with its state, except for two arrays that the caller owns;
// initialised by bowden_iterative_learning_init or bowden_iterative_learning_resume.
typedef struct bowden_iterative_learning_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_ITERATIVE_LEARNING_F32_WORDS];
} bowden_iterative_learning_f32;

// Settings of iterative learning. A cycle is divided into cells of equal phase; with e
// the mean of reference - measured over a cell, and w(k) a triangle of area 1:
//
//     v(c) = (1 - forgetting)*learned(c) + gain*e(c + lead)
//     learned(c) = sum of w(k)*v(c + k), k from -half_width to half_width
//
// Start from NAME_INIT. By default nothing is forgotten; all other fields must be set.
typedef struct bowden_iterative_learning_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Gain of the error, not zero, with the sign of the plant's gain [command
    // unit/output unit].
    float gain;
    // Greatest magnitude of the learned values, above zero [command unit].
    float limit;
    // Share of a learned value that is forgotten per cycle, from 0 to 1.
    float forgetting;
    // Number of cells from a command to its effect.
    uint16_t lead;
    // Half-width of the triangle [cells]; 0 means no filter.
    uint16_t half_width;
} bowden_iterative_learning_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_iterative_learning_settings_f32 settings = BOWDEN_ITERATIVE_LEARNING_SETTINGS_F32_INIT;
#define BOWDEN_ITERATIVE_LEARNING_SETTINGS_F32_INIT { \
    1114661433u, /* init_mark */ \
    0.0f, /* gain */ \
    0.0f, /* limit */ \
    0.0f, /* forgetting */ \
    65535u, /* lead */ \
    65535u /* half_width */ \
}

// Output of a step of iterative learning.
typedef struct bowden_iterative_learning_output_f32 {
    // Value to add to the command through the feed_forward of a controller [command
    // unit]: always finite and within the limit.
    float feed_forward;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
} bowden_iterative_learning_output_f32;

// Iterative learning with its state, except for two arrays that the caller owns;
// initialised by bowden_iterative_learning_init or bowden_iterative_learning_resume.
typedef struct bowden_iterative_learning_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_ITERATIVE_LEARNING_F64_WORDS];
} bowden_iterative_learning_f64;

// Settings of iterative learning. A cycle is divided into cells of equal phase; with e
// the mean of reference - measured over a cell, and w(k) a triangle of area 1:
//
//     v(c) = (1 - forgetting)*learned(c) + gain*e(c + lead)
//     learned(c) = sum of w(k)*v(c + k), k from -half_width to half_width
//
// Start from NAME_INIT. By default nothing is forgotten; all other fields must be set.
typedef struct bowden_iterative_learning_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Gain of the error, not zero, with the sign of the plant's gain [command
    // unit/output unit].
    double gain;
    // Greatest magnitude of the learned values, above zero [command unit].
    double limit;
    // Share of a learned value that is forgotten per cycle, from 0 to 1.
    double forgetting;
    // Number of cells from a command to its effect.
    uint16_t lead;
    // Half-width of the triangle [cells]; 0 means no filter.
    uint16_t half_width;
} bowden_iterative_learning_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_iterative_learning_settings_f64 settings = BOWDEN_ITERATIVE_LEARNING_SETTINGS_F64_INIT;
#define BOWDEN_ITERATIVE_LEARNING_SETTINGS_F64_INIT { \
    3596890953u, /* init_mark */ \
    0.0, /* gain */ \
    0.0, /* limit */ \
    0.0, /* forgetting */ \
    65535u, /* lead */ \
    65535u /* half_width */ \
}

// Output of a step of iterative learning.
typedef struct bowden_iterative_learning_output_f64 {
    // Value to add to the command through the feed_forward of a controller [command
    // unit]: always finite and within the limit.
    double feed_forward;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
} bowden_iterative_learning_output_f64;

// One sample for a model.
typedef struct bowden_model_sample_f32 {
    // Time since the previous sample, above zero also at the first sample [s].
    float dt;
    // The transmission's input, x or tau_i, with its rates.
    struct bowden_motion_f32 input;
    // The transmitted load: tau_i in torque mode, otherwise a load channel.
    float load;
    // All other channels, in the order in the model's file; may be null if there are
    // none.
    const struct bowden_motion_f32 *channels;
    // Number of channels, at most BOWDEN_CHANNELS.
    size_t channel_count;
} bowden_model_sample_f32;

// One sample for a model.
typedef struct bowden_model_sample_f64 {
    // Time since the previous sample, above zero also at the first sample [s].
    double dt;
    // The transmission's input, x or tau_i, with its rates.
    struct bowden_motion_f64 input;
    // The transmitted load: tau_i in torque mode, otherwise a load channel.
    double load;
    // All other channels, in the order in the model's file; may be null if there are
    // none.
    const struct bowden_motion_f64 *channels;
    // Number of channels, at most BOWDEN_CHANNELS.
    size_t channel_count;
} bowden_model_sample_f64;

// An observer with its state; initialised by bowden_observer_init.
typedef struct bowden_observer_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_OBSERVER_F32_WORDS];
} bowden_observer_f32;

// Settings of a disturbance observer. The nominal plant from command to output is
//
//     P(s) = gain/(s^2/wn^2 + 2*zeta*s/wn + 1)
//
// for a motor with inertia J and damping c that works against a stiffness K: wn =
// sqrt(K/J), zeta = c/(2*sqrt(K*J)). If wn and gain are uncertain, choose low values.
//
// Start from NAME_INIT. By default the latency is 0; all other fields must be set.
typedef struct bowden_observer_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Gain of the nominal plant, not zero [output unit/command unit].
    float gain;
    // wn of the nominal plant, above zero [rad/s].
    float natural_frequency;
    // zeta of the nominal plant, zero or above.
    float damping_ratio;
    // tau of the filter Q = 1/(tau*s + 1)^2, above zero [s].
    float time_constant;
    // Greatest magnitude of the estimate, above zero [command unit].
    float limit;
    // Longest dt of a good sample, above zero [s].
    float longest_dt;
    // Time from a command to its effect in the measured output, without the response
    // of the nominal plant; zero or above [s].
    float latency;
} bowden_observer_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_observer_settings_f32 settings = BOWDEN_OBSERVER_SETTINGS_F32_INIT;
#define BOWDEN_OBSERVER_SETTINGS_F32_INIT { \
    2085529698u, /* init_mark */ \
    0.0f, /* gain */ \
    0.0f, /* natural_frequency */ \
    -1.0f, /* damping_ratio */ \
    0.0f, /* time_constant */ \
    0.0f, /* limit */ \
    0.0f, /* longest_dt */ \
    0.0f /* latency */ \
}

// Output of a step of an observer.
typedef struct bowden_observer_output_f32 {
    // Value to add to the command through the feed_forward of a controller [command
    // unit]: always finite and within the limit.
    float estimate;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
} bowden_observer_output_f32;

// An observer with its state; initialised by bowden_observer_init.
typedef struct bowden_observer_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_OBSERVER_F64_WORDS];
} bowden_observer_f64;

// Settings of a disturbance observer. The nominal plant from command to output is
//
//     P(s) = gain/(s^2/wn^2 + 2*zeta*s/wn + 1)
//
// for a motor with inertia J and damping c that works against a stiffness K: wn =
// sqrt(K/J), zeta = c/(2*sqrt(K*J)). If wn and gain are uncertain, choose low values.
//
// Start from NAME_INIT. By default the latency is 0; all other fields must be set.
typedef struct bowden_observer_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Gain of the nominal plant, not zero [output unit/command unit].
    double gain;
    // wn of the nominal plant, above zero [rad/s].
    double natural_frequency;
    // zeta of the nominal plant, zero or above.
    double damping_ratio;
    // tau of the filter Q = 1/(tau*s + 1)^2, above zero [s].
    double time_constant;
    // Greatest magnitude of the estimate, above zero [command unit].
    double limit;
    // Longest dt of a good sample, above zero [s].
    double longest_dt;
    // Time from a command to its effect in the measured output, without the response
    // of the nominal plant; zero or above [s].
    double latency;
} bowden_observer_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_observer_settings_f64 settings = BOWDEN_OBSERVER_SETTINGS_F64_INIT;
#define BOWDEN_OBSERVER_SETTINGS_F64_INIT { \
    3898276114u, /* init_mark */ \
    0.0, /* gain */ \
    0.0, /* natural_frequency */ \
    -1.0, /* damping_ratio */ \
    0.0, /* time_constant */ \
    0.0, /* limit */ \
    0.0, /* longest_dt */ \
    0.0 /* latency */ \
}

// Output of a step of an observer.
typedef struct bowden_observer_output_f64 {
    // Value to add to the command through the feed_forward of a controller [command
    // unit]: always finite and within the limit.
    double estimate;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
} bowden_observer_output_f64;

// Settings of a PI (15), PID (14) or PIV (16):
//
//     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*d/dt(y - c*y_r) + u_ff
//     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*v_d             + u_ff    (PIV)
//     command = u within the range and the slew-rate limit;  e = y - y_r
//
// Start from NAME_INIT. By default: full set-point weight, derivative on the
// measurement, conditional anti-windup, no slew-rate limit, 4 good samples to cancel a
// bad one, and gains and a safe command of 0. Limits, longest_dt and `after` must be
// set.
typedef struct bowden_pid_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Proportional gain [command unit/output unit].
    float k_p;
    // Integral gain [command unit/(output unit*s)], with the sign of k_p.
    float k_i;
    // Derivative gain [command unit*s/output unit], with the sign of k_p; for PIV
    // [command unit*s/rad]. 0 for a PI.
    float k_d;
    // One of bowden_derivative_source: the signal that k_d multiplies.
    uint32_t damping;
    // Set-point weight c of the derivative, 0 to 1: with 0, the default, it acts on
    // the measurement; with 1 it acts on the error, and a step of the reference causes
    // a derivative kick.
    float derivative_weight;
    // Time constant of the derivative filter, zero (no filter) or above [s].
    float derivative_time;
    // Set-point weight b of the proportional term, 0 to 1; 1 by default.
    float setpoint_weight;
    // One of bowden_anti_windup.
    uint32_t anti_windup;
    // Tracking time, for BOWDEN_ANTI_WINDUP_BACK_CALCULATION only; above zero [s].
    float tracking_time;
    // Greatest magnitude of the integral term, above zero [command unit]; 0 for none.
    float integral_limit;
    // The integral is frozen while |e| is at most this value, zero (no deadband) or
    // above [output unit]. To prevent the limit cycle of static friction, make it
    // wider than the jump.
    float deadband;
    // Period of an output that wraps, above zero [output unit], such as 360 degrees; 0
    // for none. Errors and changes are then measured along the shorter way round.
    float period;
    // Range and slew-rate limit of the command.
    struct bowden_limits_f32 limits;
    // Longest dt of a good sample, above zero [s]: for example five nominal steps.
    float longest_dt;
    // Fallback after repeated bad samples.
    struct bowden_fallback_f32 fallback;
} bowden_pid_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_pid_settings_f32 settings = BOWDEN_PID_SETTINGS_F32_INIT;
#define BOWDEN_PID_SETTINGS_F32_INIT { \
    769246782u, /* init_mark */ \
    0.0f, /* k_p */ \
    0.0f, /* k_i */ \
    0.0f, /* k_d */ \
    0u, /* damping */ \
    0.0f, /* derivative_weight */ \
    0.0f, /* derivative_time */ \
    1.0f, /* setpoint_weight */ \
    0u, /* anti_windup */ \
    0.0f, /* tracking_time */ \
    0.0f, /* integral_limit */ \
    0.0f, /* deadband */ \
    0.0f, /* period */ \
    {3.4028235e38f, -3.4028235e38f, 0.0f}, /* limits */ \
    0.0f, /* longest_dt */ \
    {0u, 4u, 0.0f} /* fallback */ \
}

// A PI, PID or PIV with its state, in the caller's memory; initialised by
// bowden_pid_init. The object may be copied and moved as a whole.
typedef struct bowden_pid_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_PID_F32_WORDS];
} bowden_pid_f32;

// One sample for a PI, PID or PIV.
typedef struct bowden_pid_sample_f32 {
    // Time since the last call [s], also after a bad sample.
    float dt;
    // Reference y_r [output unit], such as [N*m].
    float reference;
    // Measured output y [output unit], such as [N*m].
    float measured;
    // Measured distal velocity [rad/s]; only PIV (16) reads it.
    float velocity;
    // Feed-forward, added to the command before the limits [command unit]; 0 for none.
    float feed_forward;
} bowden_pid_sample_f32;

// Every term of the last good sample; they add up to `unlimited`.
typedef struct bowden_pid_terms_f32 {
    // e = y - y_r [output unit].
    float error;
    // -k_p*(y - b*y_r) [command unit].
    float proportional;
    // -k_i*integral(e), after the anti-windup [command unit].
    float integral;
    // -k_d*d/dt(y - c*y_r), filtered [command unit]; zero with PIV.
    float derivative;
    // -k_d*v_d of PIV [command unit]; zero with PI and PID.
    float velocity;
    // Feed-forward of the sample [command unit].
    float feed_forward;
    // The sum before range and slew-rate limit [command unit].
    float unlimited;
    // 1 if the range or the slew-rate limit changed the command, otherwise 0.
    uint32_t saturated;
} bowden_pid_terms_f32;

// Settings of a PI (15), PID (14) or PIV (16):
//
//     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*d/dt(y - c*y_r) + u_ff
//     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*v_d             + u_ff    (PIV)
//     command = u within the range and the slew-rate limit;  e = y - y_r
//
// Start from NAME_INIT. By default: full set-point weight, derivative on the
// measurement, conditional anti-windup, no slew-rate limit, 4 good samples to cancel a
// bad one, and gains and a safe command of 0. Limits, longest_dt and `after` must be
// set.
typedef struct bowden_pid_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Proportional gain [command unit/output unit].
    double k_p;
    // Integral gain [command unit/(output unit*s)], with the sign of k_p.
    double k_i;
    // Derivative gain [command unit*s/output unit], with the sign of k_p; for PIV
    // [command unit*s/rad]. 0 for a PI.
    double k_d;
    // One of bowden_derivative_source: the signal that k_d multiplies.
    uint32_t damping;
    // Set-point weight c of the derivative, 0 to 1: with 0, the default, it acts on
    // the measurement; with 1 it acts on the error, and a step of the reference causes
    // a derivative kick.
    double derivative_weight;
    // Time constant of the derivative filter, zero (no filter) or above [s].
    double derivative_time;
    // Set-point weight b of the proportional term, 0 to 1; 1 by default.
    double setpoint_weight;
    // One of bowden_anti_windup.
    uint32_t anti_windup;
    // Tracking time, for BOWDEN_ANTI_WINDUP_BACK_CALCULATION only; above zero [s].
    double tracking_time;
    // Greatest magnitude of the integral term, above zero [command unit]; 0 for none.
    double integral_limit;
    // The integral is frozen while |e| is at most this value, zero (no deadband) or
    // above [output unit]. To prevent the limit cycle of static friction, make it
    // wider than the jump.
    double deadband;
    // Period of an output that wraps, above zero [output unit], such as 360 degrees; 0
    // for none. Errors and changes are then measured along the shorter way round.
    double period;
    // Range and slew-rate limit of the command.
    struct bowden_limits_f64 limits;
    // Longest dt of a good sample, above zero [s]: for example five nominal steps.
    double longest_dt;
    // Fallback after repeated bad samples.
    struct bowden_fallback_f64 fallback;
} bowden_pid_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_pid_settings_f64 settings = BOWDEN_PID_SETTINGS_F64_INIT;
#define BOWDEN_PID_SETTINGS_F64_INIT { \
    3117258574u, /* init_mark */ \
    0.0, /* k_p */ \
    0.0, /* k_i */ \
    0.0, /* k_d */ \
    0u, /* damping */ \
    0.0, /* derivative_weight */ \
    0.0, /* derivative_time */ \
    1.0, /* setpoint_weight */ \
    0u, /* anti_windup */ \
    0.0, /* tracking_time */ \
    0.0, /* integral_limit */ \
    0.0, /* deadband */ \
    0.0, /* period */ \
    {1.7976931348623157e308, -1.7976931348623157e308, 0.0}, /* limits */ \
    0.0, /* longest_dt */ \
    {0u, 4u, 0.0} /* fallback */ \
}

// A PI, PID or PIV with its state, in the caller's memory; initialised by
// bowden_pid_init. The object may be copied and moved as a whole.
typedef struct bowden_pid_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_PID_F64_WORDS];
} bowden_pid_f64;

// One sample for a PI, PID or PIV.
typedef struct bowden_pid_sample_f64 {
    // Time since the last call [s], also after a bad sample.
    double dt;
    // Reference y_r [output unit], such as [N*m].
    double reference;
    // Measured output y [output unit], such as [N*m].
    double measured;
    // Measured distal velocity [rad/s]; only PIV (16) reads it.
    double velocity;
    // Feed-forward, added to the command before the limits [command unit]; 0 for none.
    double feed_forward;
} bowden_pid_sample_f64;

// Every term of the last good sample; they add up to `unlimited`.
typedef struct bowden_pid_terms_f64 {
    // e = y - y_r [output unit].
    double error;
    // -k_p*(y - b*y_r) [command unit].
    double proportional;
    // -k_i*integral(e), after the anti-windup [command unit].
    double integral;
    // -k_d*d/dt(y - c*y_r), filtered [command unit]; zero with PIV.
    double derivative;
    // -k_d*v_d of PIV [command unit]; zero with PI and PID.
    double velocity;
    // Feed-forward of the sample [command unit].
    double feed_forward;
    // The sum before range and slew-rate limit [command unit].
    double unlimited;
    // 1 if the range or the slew-rate limit changed the command, otherwise 0.
    uint32_t saturated;
} bowden_pid_terms_f64;

// A check of samples with its state; initialised by bowden_plausible_init.
typedef struct bowden_plausible_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_PLAUSIBLE_F32_WORDS];
} bowden_plausible_f32;

// Settings of a check of samples.
//
// Start from NAME_INIT. By default only the range is checked; low and high must be
// set.
typedef struct bowden_plausible_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Least plausible sample [signal unit].
    float low;
    // Greatest plausible sample [signal unit]; above `low`.
    float high;
    // Greatest rate of the signal, above zero [signal unit/s]; 0 for none. Do not use
    // it for an angle that wraps.
    float rate;
    // Longest time of the sensor from one reading to the next, including jitter, above
    // zero [s]; 0 if unknown. If it is set, a repeated reading is taken to be at most
    // this old. Without a rate this setting has no effect.
    float sample_period;
    // Number of equal samples in a row that mean a stuck sensor, counted while the
    // machine moves; 0 for never.
    uint32_t stuck_after;
    // A longer or unusable dt counts as this dt, above zero [s]. With 0 such a time is
    // unknown.
    float longest_dt;
} bowden_plausible_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_plausible_settings_f32 settings = BOWDEN_PLAUSIBLE_SETTINGS_F32_INIT;
#define BOWDEN_PLAUSIBLE_SETTINGS_F32_INIT { \
    805770662u, /* init_mark */ \
    3.4028235e38f, /* low */ \
    -3.4028235e38f, /* high */ \
    0.0f, /* rate */ \
    0.0f, /* sample_period */ \
    0u, /* stuck_after */ \
    0.0f /* longest_dt */ \
}

// Output of a check of a sample.
typedef struct bowden_plausible_output_f32 {
    // The sample, or NaN if it is not plausible; for a controller, NaN is a bad
    // sample.
    float value;
    // Status of the step, equal to its return value.
    bowden_result result;
    // Why the sample is implausible.
    bowden_implausible reason;
} bowden_plausible_output_f32;

// A check of samples with its state; initialised by bowden_plausible_init.
typedef struct bowden_plausible_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_PLAUSIBLE_F64_WORDS];
} bowden_plausible_f64;

// Settings of a check of samples.
//
// Start from NAME_INIT. By default only the range is checked; low and high must be
// set.
typedef struct bowden_plausible_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Least plausible sample [signal unit].
    double low;
    // Greatest plausible sample [signal unit]; above `low`.
    double high;
    // Greatest rate of the signal, above zero [signal unit/s]; 0 for none. Do not use
    // it for an angle that wraps.
    double rate;
    // Longest time of the sensor from one reading to the next, including jitter, above
    // zero [s]; 0 if unknown. If it is set, a repeated reading is taken to be at most
    // this old. Without a rate this setting has no effect.
    double sample_period;
    // Number of equal samples in a row that mean a stuck sensor, counted while the
    // machine moves; 0 for never.
    uint32_t stuck_after;
    // A longer or unusable dt counts as this dt, above zero [s]. With 0 such a time is
    // unknown.
    double longest_dt;
} bowden_plausible_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_plausible_settings_f64 settings = BOWDEN_PLAUSIBLE_SETTINGS_F64_INIT;
#define BOWDEN_PLAUSIBLE_SETTINGS_F64_INIT { \
    2752726230u, /* init_mark */ \
    1.7976931348623157e308, /* low */ \
    -1.7976931348623157e308, /* high */ \
    0.0, /* rate */ \
    0.0, /* sample_period */ \
    0u, /* stuck_after */ \
    0.0 /* longest_dt */ \
}

// Output of a check of a sample.
typedef struct bowden_plausible_output_f64 {
    // The sample, or NaN if it is not plausible; for a controller, NaN is a bad
    // sample.
    double value;
    // Status of the step, equal to its return value.
    bowden_result result;
    // Why the sample is implausible.
    bowden_implausible reason;
} bowden_plausible_output_f64;

// A play with its state; initialised by bowden_play_init.
typedef struct bowden_play_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_PLAY_F32_WORDS];
} bowden_play_f32;

// A play with its state; initialised by bowden_play_init.
typedef struct bowden_play_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_PLAY_F64_WORDS];
} bowden_play_f64;

// Rates with their state; initialised by bowden_rates_init.
typedef struct bowden_rates_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_RATES_F32_WORDS];
} bowden_rates_f32;

// Settings of rates: two lags with the same time constant, see bowden_rates_step.
//
// Start from NAME_INIT. By default the position does not wrap and longest_gap is ten
// time constants; time_constant must be set.
typedef struct bowden_rates_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Time constant of both lags, above zero [s].
    float time_constant;
    // Period of a position that wraps, such as a counter's, above zero [channel unit];
    // 0 for none.
    float period;
    // Longest gap between two good samples that the rates bridge, above zero [s]; 0
    // for ten time constants.
    float longest_gap;
} bowden_rates_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_rates_settings_f32 settings = BOWDEN_RATES_SETTINGS_F32_INIT;
#define BOWDEN_RATES_SETTINGS_F32_INIT { \
    1685829321u, /* init_mark */ \
    0.0f, /* time_constant */ \
    0.0f, /* period */ \
    0.0f /* longest_gap */ \
}

// Output of a step of the rates.
typedef struct bowden_rates_output_f32 {
    // Position (unwrapped), velocity and acceleration; finite, zero before the
    // first good sample.
    struct bowden_motion_f32 motion;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
} bowden_rates_output_f32;

// Rates with their state; initialised by bowden_rates_init.
typedef struct bowden_rates_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_RATES_F64_WORDS];
} bowden_rates_f64;

// Settings of rates: two lags with the same time constant, see bowden_rates_step.
//
// Start from NAME_INIT. By default the position does not wrap and longest_gap is ten
// time constants; time_constant must be set.
typedef struct bowden_rates_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Time constant of both lags, above zero [s].
    double time_constant;
    // Period of a position that wraps, such as a counter's, above zero [channel unit];
    // 0 for none.
    double period;
    // Longest gap between two good samples that the rates bridge, above zero [s]; 0
    // for ten time constants.
    double longest_gap;
} bowden_rates_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_rates_settings_f64 settings = BOWDEN_RATES_SETTINGS_F64_INIT;
#define BOWDEN_RATES_SETTINGS_F64_INIT { \
    4033865657u, /* init_mark */ \
    0.0, /* time_constant */ \
    0.0, /* period */ \
    0.0 /* longest_gap */ \
}

// Output of a step of the rates.
typedef struct bowden_rates_output_f64 {
    // Position (unwrapped), velocity and acceleration; finite, zero before the
    // first good sample.
    struct bowden_motion_f64 motion;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input, if there is one.
    bowden_fault fault;
} bowden_rates_output_f64;

// A relay experiment with its state, in the caller's memory; initialised by
// bowden_relay_init.
typedef struct bowden_relay_f32 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_RELAY_F32_WORDS];
} bowden_relay_f32;

// Settings of a relay experiment, which makes the loop oscillate about the reference:
//
//     command = centre + amplitude   from y < reference - hysteresis on
//     command = centre - amplitude   from y > reference + hysteresis on
//
// Start from NAME_INIT. By default 4 good samples cancel a bad one, and the safe
// command is 0; all other fields must be set.
typedef struct bowden_relay_settings_f32 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Reference y_r, about which the output oscillates [output unit].
    float reference;
    // Mean of the two levels of the command [command unit]. The command that holds the
    // output at the reference gives equal half-periods.
    float centre;
    // Distance from the centre to each level, not zero, with the sign of the plant's
    // gain [command unit].
    float amplitude;
    // Hysteresis of the relay, zero or above [output unit]: at least the peak of the
    // noise.
    float hysteresis;
    // Greatest distance of the output from the reference, above `hysteresis`
    // [output unit]. One sample beyond it ends the experiment.
    float most_deviation;
    // Number of successive cycles in the average, at least 2.
    uint32_t cycles;
    // Largest deviation of a cycle from the mean of earlier cycles, as a share of this
    // mean, between 0 and 1.
    float agreement;
    // Maximum duration of the experiment, at least `longest_dt` [s].
    float longest_time;
    // Longest dt of a good sample, above zero [s].
    float longest_dt;
    // Range of the command, without a slew-rate limit.
    struct bowden_limits_f32 limits;
    // Fallback after a failure; BOWDEN_HOLD_FOR_EVER is refused.
    struct bowden_fallback_f32 fallback;
} bowden_relay_settings_f32;

// The defaults, in C99 and C++11:
//
//     bowden_relay_settings_f32 settings = BOWDEN_RELAY_SETTINGS_F32_INIT;
#define BOWDEN_RELAY_SETTINGS_F32_INIT { \
    3658256175u, /* init_mark */ \
    3.4028235e38f, /* reference */ \
    3.4028235e38f, /* centre */ \
    0.0f, /* amplitude */ \
    -1.0f, /* hysteresis */ \
    0.0f, /* most_deviation */ \
    0u, /* cycles */ \
    0.0f, /* agreement */ \
    0.0f, /* longest_time */ \
    0.0f, /* longest_dt */ \
    {3.4028235e38f, -3.4028235e38f, 0.0f}, /* limits */ \
    {0u, 4u, 0.0f} /* fallback */ \
}

// Result of a relay experiment.
typedef struct bowden_ultimate_f32 {
    // Ultimate gain, with the sign of the relay's amplitude [command unit/output
    // unit].
    float gain;
    // Ultimate period [s].
    float period;
    // Half the distance from the lowest to the highest output [output unit].
    float amplitude;
    // Share of the period in which the command is centre + amplitude.
    float duty;
} bowden_ultimate_f32;

// Output of a step of a relay experiment.
typedef struct bowden_relay_output_f32 {
    // Command for the drive [command unit]: finite and within the limits.
    float command;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input of a sample.
    bowden_fault fault;
    // Phase of the experiment.
    bowden_relay_phase phase;
    // Why the experiment failed.
    bowden_relay_failure failure;
    // Number of complete cycles.
    uint32_t cycles;
    // The result; zero until the experiment is done.
    struct bowden_ultimate_f32 ultimate;
} bowden_relay_output_f32;

// Gains of a PI, for bowden_pid_settings.
typedef struct bowden_pi_gains_f32 {
    // Proportional gain [command unit/output unit].
    float k_p;
    // Integral gain [command unit/(output unit*s)].
    float k_i;
} bowden_pi_gains_f32;

// A relay experiment with its state, in the caller's memory; initialised by
// bowden_relay_init.
typedef struct bowden_relay_f64 {
    // Private; do not use.
    uint64_t opaque[BOWDEN_RELAY_F64_WORDS];
} bowden_relay_f64;

// Settings of a relay experiment, which makes the loop oscillate about the reference:
//
//     command = centre + amplitude   from y < reference - hysteresis on
//     command = centre - amplitude   from y > reference + hysteresis on
//
// Start from NAME_INIT. By default 4 good samples cancel a bad one, and the safe
// command is 0; all other fields must be set.
typedef struct bowden_relay_settings_f64 {
    // The mark that the macro NAME_INIT sets; settings without it are refused.
    uint32_t init_mark;
    // Reference y_r, about which the output oscillates [output unit].
    double reference;
    // Mean of the two levels of the command [command unit]. The command that holds the
    // output at the reference gives equal half-periods.
    double centre;
    // Distance from the centre to each level, not zero, with the sign of the plant's
    // gain [command unit].
    double amplitude;
    // Hysteresis of the relay, zero or above [output unit]: at least the peak of the
    // noise.
    double hysteresis;
    // Greatest distance of the output from the reference, above `hysteresis`
    // [output unit]. One sample beyond it ends the experiment.
    double most_deviation;
    // Number of successive cycles in the average, at least 2.
    uint32_t cycles;
    // Largest deviation of a cycle from the mean of earlier cycles, as a share of this
    // mean, between 0 and 1.
    double agreement;
    // Maximum duration of the experiment, at least `longest_dt` [s].
    double longest_time;
    // Longest dt of a good sample, above zero [s].
    double longest_dt;
    // Range of the command, without a slew-rate limit.
    struct bowden_limits_f64 limits;
    // Fallback after a failure; BOWDEN_HOLD_FOR_EVER is refused.
    struct bowden_fallback_f64 fallback;
} bowden_relay_settings_f64;

// The defaults, in C99 and C++11:
//
//     bowden_relay_settings_f64 settings = BOWDEN_RELAY_SETTINGS_F64_INIT;
#define BOWDEN_RELAY_SETTINGS_F64_INIT { \
    1310252639u, /* init_mark */ \
    1.7976931348623157e308, /* reference */ \
    1.7976931348623157e308, /* centre */ \
    0.0, /* amplitude */ \
    -1.0, /* hysteresis */ \
    0.0, /* most_deviation */ \
    0u, /* cycles */ \
    0.0, /* agreement */ \
    0.0, /* longest_time */ \
    0.0, /* longest_dt */ \
    {1.7976931348623157e308, -1.7976931348623157e308, 0.0}, /* limits */ \
    {0u, 4u, 0.0} /* fallback */ \
}

// Result of a relay experiment.
typedef struct bowden_ultimate_f64 {
    // Ultimate gain, with the sign of the relay's amplitude [command unit/output
    // unit].
    double gain;
    // Ultimate period [s].
    double period;
    // Half the distance from the lowest to the highest output [output unit].
    double amplitude;
    // Share of the period in which the command is centre + amplitude.
    double duty;
} bowden_ultimate_f64;

// Output of a step of a relay experiment.
typedef struct bowden_relay_output_f64 {
    // Command for the drive [command unit]: finite and within the limits.
    double command;
    // Status of the step, equal to its return value.
    bowden_result result;
    // The bad input of a sample.
    bowden_fault fault;
    // Phase of the experiment.
    bowden_relay_phase phase;
    // Why the experiment failed.
    bowden_relay_failure failure;
    // Number of complete cycles.
    uint32_t cycles;
    // The result; zero until the experiment is done.
    struct bowden_ultimate_f64 ultimate;
} bowden_relay_output_f64;

// Gains of a PI, for bowden_pid_settings.
typedef struct bowden_pi_gains_f64 {
    // Proportional gain [command unit/output unit].
    double k_p;
    // Integral gain [command unit/(output unit*s)].
    double k_i;
} bowden_pi_gains_f64;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Checks the settings and starts with the initial estimates.
//
// `about` may be null; otherwise it receives the name of the refused setting. On an
// error the object does not change.
bowden_result bowden_adaptive_init_f32(struct bowden_adaptive_f32 *law,
                                       const struct bowden_adaptive_settings_f32 *settings,
                                       struct bowden_about *about);

// Processes one sample; `out` receives the command and its status, as from
// bowden_pid_step.
bowden_result bowden_adaptive_step_f32(struct bowden_adaptive_f32 *law,
                                       const struct bowden_adaptive_sample_f32 *sample,
                                       struct bowden_output_f32 *out);

// The present estimates of the law.
bowden_result bowden_adaptive_get_estimates_f32(const struct bowden_adaptive_f32 *law,
                                                struct bowden_estimates_f32 *out);

// Reports the command [command unit] that the drive applied after the last step, as
// bowden_pid_applied does. z then moves no further towards this limit of the drive,
// and the estimates do not change.
bowden_result bowden_adaptive_applied_f32(struct bowden_adaptive_f32 *law, float command);

// Reports at which limit the drive was after the last step, as bowden_pid_at_limit
// does.
bowden_result bowden_adaptive_at_limit_f32(struct bowden_adaptive_f32 *law, uint32_t saturation);

// Acknowledges the fault, as bowden_pid_acknowledge does.
bowden_result bowden_adaptive_acknowledge_f32(struct bowden_adaptive_f32 *law);

// Resets the accumulated error and the estimates; the applied command is kept, and a
// latched safe command stays latched.
bowden_result bowden_adaptive_reset_f32(struct bowden_adaptive_f32 *law);

// Prepares a stored object for a start, as bowden_pid_restore does; the estimates are
// kept.
bowden_result bowden_adaptive_restore_f32(struct bowden_adaptive_f32 *law);

// Changes the settings of a running loop without a jump of the command on this sample,
// as bowden_pid_change does. The estimates are kept, each within its new bounds, and a
// latched safe command stays latched.
bowden_result bowden_adaptive_change_f32(struct bowden_adaptive_f32 *law,
                                         const struct bowden_adaptive_settings_f32 *settings,
                                         const struct bowden_adaptive_sample_f32 *sample,
                                         struct bowden_about *about);

// Starts with the initial estimates so that the next step on this sample commands
// `command` [command unit], as bowden_pid_resume does.
bowden_result bowden_adaptive_resume_f32(struct bowden_adaptive_f32 *law,
                                         float command,
                                         const struct bowden_adaptive_sample_f32 *sample,
                                         struct bowden_output_f32 *out);

// Sets `latched` to 1 while the safe command is latched, otherwise to 0.
bowden_result bowden_adaptive_is_latched_f32(const struct bowden_adaptive_f32 *law,
                                             uint32_t *latched);

// Checks the settings and starts with the initial estimates.
//
// `about` may be null; otherwise it receives the name of the refused setting. On an
// error the object does not change.
bowden_result bowden_adaptive_init_f64(struct bowden_adaptive_f64 *law,
                                       const struct bowden_adaptive_settings_f64 *settings,
                                       struct bowden_about *about);

// Processes one sample; `out` receives the command and its status, as from
// bowden_pid_step.
bowden_result bowden_adaptive_step_f64(struct bowden_adaptive_f64 *law,
                                       const struct bowden_adaptive_sample_f64 *sample,
                                       struct bowden_output_f64 *out);

// The present estimates of the law.
bowden_result bowden_adaptive_get_estimates_f64(const struct bowden_adaptive_f64 *law,
                                                struct bowden_estimates_f64 *out);

// Reports the command [command unit] that the drive applied after the last step, as
// bowden_pid_applied does. z then moves no further towards this limit of the drive,
// and the estimates do not change.
bowden_result bowden_adaptive_applied_f64(struct bowden_adaptive_f64 *law, double command);

// Reports at which limit the drive was after the last step, as bowden_pid_at_limit
// does.
bowden_result bowden_adaptive_at_limit_f64(struct bowden_adaptive_f64 *law, uint32_t saturation);

// Acknowledges the fault, as bowden_pid_acknowledge does.
bowden_result bowden_adaptive_acknowledge_f64(struct bowden_adaptive_f64 *law);

// Resets the accumulated error and the estimates; the applied command is kept, and a
// latched safe command stays latched.
bowden_result bowden_adaptive_reset_f64(struct bowden_adaptive_f64 *law);

// Prepares a stored object for a start, as bowden_pid_restore does; the estimates are
// kept.
bowden_result bowden_adaptive_restore_f64(struct bowden_adaptive_f64 *law);

// Changes the settings of a running loop without a jump of the command on this sample,
// as bowden_pid_change does. The estimates are kept, each within its new bounds, and a
// latched safe command stays latched.
bowden_result bowden_adaptive_change_f64(struct bowden_adaptive_f64 *law,
                                         const struct bowden_adaptive_settings_f64 *settings,
                                         const struct bowden_adaptive_sample_f64 *sample,
                                         struct bowden_about *about);

// Starts with the initial estimates so that the next step on this sample commands
// `command` [command unit], as bowden_pid_resume does.
bowden_result bowden_adaptive_resume_f64(struct bowden_adaptive_f64 *law,
                                         double command,
                                         const struct bowden_adaptive_sample_f64 *sample,
                                         struct bowden_output_f64 *out);

// Sets `latched` to 1 while the safe command is latched, otherwise to 0.
bowden_result bowden_adaptive_is_latched_f64(const struct bowden_adaptive_f64 *law,
                                             uint32_t *latched);

// Inverts a loaded model, (5)-(7), and starts at zero:
//
//     tau_i = inverse transmission(desired - sum of gain*regressor, eta)
//
// A dt longer than `longest_dt` [s] is a bad sample. Motions are clamped to `ranges`,
// which may be null if `range_count` is 0; a term of the model must read the source of
// each range. The result is BOWDEN_RESULT_ERROR_INADMISSIBLE if the model has no
// inverse. The compensator does not use the model afterwards. On an error the object
// does not change. `about` may be null.
bowden_result bowden_compensator_init_f32(struct bowden_compensator_f32 *compensator,
                                          const struct bowden_model_f32 *model,
                                          float longest_dt,
                                          const struct bowden_range_f32 *ranges,
                                          size_t range_count,
                                          struct bowden_about *about);

// Puts a play with this half-width [output unit], zero or more, on the desired torque
// of the cable. Zero, the default after init, means no play.
//
// A term that reads a velocity from encoder counts reverses the torque at each count.
// After a reversal the inverse is steep, so the command chatters. A half-width a
// little above half of one count's effect on the torque, |gain|*count/(2*time
// constant), removes these reversals. On an error the object does not change.
bowden_result bowden_compensator_set_play_f32(struct bowden_compensator_f32 *compensator,
                                              float half_width,
                                              struct bowden_about *about);

// Computes, for one sample, the input for which the model's output is `desired`.
//
// A bad sample leaves the state unchanged and holds the last good command, zero before
// the first one: BOWDEN_RESULT_HELD. `out` is written if the result is not negative.
bowden_result bowden_compensator_step_f32(struct bowden_compensator_f32 *compensator,
                                          const struct bowden_compensator_sample_f32 *sample,
                                          struct bowden_compensator_output_f32 *out);

// Reports the actual input of the transmission [input unit] after the last step if it
// differs from the step's command, for example because the drive is off or another law
// adds a command.
//
// Call this function between two steps. The hysteresis then follows this input, and
// the next step continues from there. If there are two reports after one step, the
// second one applies. A number that is not finite changes nothing: BOWDEN_RESULT_HELD.
bowden_result bowden_compensator_applied_f32(struct bowden_compensator_f32 *compensator,
                                             float command);

// Reports that the drive was at this limit after the last step: one of
// bowden_saturation. Use it for a drive that does not report its command; otherwise
// use bowden_compensator_applied.
//
// Call this function between two steps. At the upper limit the input of the model does
// not rise; at the lower limit it does not fall. Any other number returns
// BOWDEN_RESULT_ERROR_CHOICE.
bowden_result bowden_compensator_at_limit_f32(struct bowden_compensator_f32 *compensator,
                                              uint32_t saturation);

// Resets the state to the start, with this hysteresis state, within -1 and 1.
bowden_result bowden_compensator_reset_f32(struct bowden_compensator_f32 *compensator, float eta);

// Inverts a loaded model, (5)-(7), and starts at zero:
//
//     tau_i = inverse transmission(desired - sum of gain*regressor, eta)
//
// A dt longer than `longest_dt` [s] is a bad sample. Motions are clamped to `ranges`,
// which may be null if `range_count` is 0; a term of the model must read the source of
// each range. The result is BOWDEN_RESULT_ERROR_INADMISSIBLE if the model has no
// inverse. The compensator does not use the model afterwards. On an error the object
// does not change. `about` may be null.
bowden_result bowden_compensator_init_f64(struct bowden_compensator_f64 *compensator,
                                          const struct bowden_model_f64 *model,
                                          double longest_dt,
                                          const struct bowden_range_f64 *ranges,
                                          size_t range_count,
                                          struct bowden_about *about);

// Puts a play with this half-width [output unit], zero or more, on the desired torque
// of the cable. Zero, the default after init, means no play.
//
// A term that reads a velocity from encoder counts reverses the torque at each count.
// After a reversal the inverse is steep, so the command chatters. A half-width a
// little above half of one count's effect on the torque, |gain|*count/(2*time
// constant), removes these reversals. On an error the object does not change.
bowden_result bowden_compensator_set_play_f64(struct bowden_compensator_f64 *compensator,
                                              double half_width,
                                              struct bowden_about *about);

// Computes, for one sample, the input for which the model's output is `desired`.
//
// A bad sample leaves the state unchanged and holds the last good command, zero before
// the first one: BOWDEN_RESULT_HELD. `out` is written if the result is not negative.
bowden_result bowden_compensator_step_f64(struct bowden_compensator_f64 *compensator,
                                          const struct bowden_compensator_sample_f64 *sample,
                                          struct bowden_compensator_output_f64 *out);

// Reports the actual input of the transmission [input unit] after the last step if it
// differs from the step's command, for example because the drive is off or another law
// adds a command.
//
// Call this function between two steps. The hysteresis then follows this input, and
// the next step continues from there. If there are two reports after one step, the
// second one applies. A number that is not finite changes nothing: BOWDEN_RESULT_HELD.
bowden_result bowden_compensator_applied_f64(struct bowden_compensator_f64 *compensator,
                                             double command);

// Reports that the drive was at this limit after the last step: one of
// bowden_saturation. Use it for a drive that does not report its command; otherwise
// use bowden_compensator_applied.
//
// Call this function between two steps. At the upper limit the input of the model does
// not rise; at the lower limit it does not fall. Any other number returns
// BOWDEN_RESULT_ERROR_CHOICE.
bowden_result bowden_compensator_at_limit_f64(struct bowden_compensator_f64 *compensator,
                                              uint32_t saturation);

// Resets the state to the start, with this hysteresis state, within -1 and 1.
bowden_result bowden_compensator_reset_f64(struct bowden_compensator_f64 *compensator, double eta);

// Checks the settings and starts a velocity from counts. `about` may be null.
bowden_result bowden_edge_velocity_init_f32(struct bowden_edge_velocity_f32 *edges,
                                            const struct bowden_edge_velocity_settings_f32 *settings,
                                            struct bowden_about *about);

// The velocity at a position [channel unit], `dt` [s] after the last call, whether
// that sample was good or bad. With M counts in a time T since the sample with the
// last count:
//
//     v+ = v + (1 - exp(-T/time_constant))*(M*count/T - v)   at a sample with counts
//     |v| <= count/(time since the last count)               at every other sample
//
// The result is BOWDEN_RESULT_SETTLING until two counts are known, and
// BOWDEN_RESULT_STOPPED after `longest_gap` without a count. A bad sample holds the
// velocity: BOWDEN_RESULT_HELD. `out` is written if the result is not negative.
bowden_result bowden_edge_velocity_step_f32(struct bowden_edge_velocity_f32 *edges,
                                            float position,
                                            float dt,
                                            struct bowden_edge_velocity_output_f32 *out);

// Checks the settings and starts a velocity from counts. `about` may be null.
bowden_result bowden_edge_velocity_init_f64(struct bowden_edge_velocity_f64 *edges,
                                            const struct bowden_edge_velocity_settings_f64 *settings,
                                            struct bowden_about *about);

// The velocity at a position [channel unit], `dt` [s] after the last call, whether
// that sample was good or bad. With M counts in a time T since the sample with the
// last count:
//
//     v+ = v + (1 - exp(-T/time_constant))*(M*count/T - v)   at a sample with counts
//     |v| <= count/(time since the last count)               at every other sample
//
// The result is BOWDEN_RESULT_SETTLING until two counts are known, and
// BOWDEN_RESULT_STOPPED after `longest_gap` without a count. A bad sample holds the
// velocity: BOWDEN_RESULT_HELD. `out` is written if the result is not negative.
bowden_result bowden_edge_velocity_step_f64(struct bowden_edge_velocity_f64 *edges,
                                            double position,
                                            double dt,
                                            struct bowden_edge_velocity_output_f64 *out);

// Starts a low-pass with a `time_constant` of at least zero [s], see
// bowden_low_pass_step. At zero the output is the sample. `about` may be null.
bowden_result bowden_low_pass_init_f32(struct bowden_low_pass_f32 *filter,
                                       float time_constant,
                                       struct bowden_about *about);

// Processes a sample taken `dt` [s] after the last call; `output` receives
//
//     y+ = y + dt/(time_constant + dt)*(x - y)
//
// The corner frequency is 1/(2*pi*time_constant) [Hz]. The first good sample starts
// the filter at rest. If the sample is not finite, or dt is not positive and finite,
// the last output is held (zero before the first sample): BOWDEN_RESULT_HELD.
bowden_result bowden_low_pass_step_f32(struct bowden_low_pass_f32 *filter,
                                       float sample,
                                       float dt,
                                       float *output);

// Checks the settings and starts a low-pass. `about` may be null.
bowden_result bowden_biquad_init_low_pass_f32(struct bowden_biquad_f32 *filter,
                                              const struct bowden_biquad_settings_f32 *settings,
                                              struct bowden_about *about);

// Checks the settings and starts a notch. `about` may be null.
bowden_result bowden_biquad_init_notch_f32(struct bowden_biquad_f32 *filter,
                                           const struct bowden_biquad_settings_f32 *settings,
                                           struct bowden_about *about);

// Processes a sample taken `dt` [s] after the last call; `output` receives the
// filtered value.
//
// The first good sample starts the filter at rest. If the sample is not finite, or dt
// is not positive and finite, the last output is held (zero before the first sample):
// BOWDEN_RESULT_HELD.
bowden_result bowden_biquad_step_f32(struct bowden_biquad_f32 *filter,
                                     float sample,
                                     float dt,
                                     float *output);

// Starts a low-pass with a `time_constant` of at least zero [s], see
// bowden_low_pass_step. At zero the output is the sample. `about` may be null.
bowden_result bowden_low_pass_init_f64(struct bowden_low_pass_f64 *filter,
                                       double time_constant,
                                       struct bowden_about *about);

// Processes a sample taken `dt` [s] after the last call; `output` receives
//
//     y+ = y + dt/(time_constant + dt)*(x - y)
//
// The corner frequency is 1/(2*pi*time_constant) [Hz]. The first good sample starts
// the filter at rest. If the sample is not finite, or dt is not positive and finite,
// the last output is held (zero before the first sample): BOWDEN_RESULT_HELD.
bowden_result bowden_low_pass_step_f64(struct bowden_low_pass_f64 *filter,
                                       double sample,
                                       double dt,
                                       double *output);

// Checks the settings and starts a low-pass. `about` may be null.
bowden_result bowden_biquad_init_low_pass_f64(struct bowden_biquad_f64 *filter,
                                              const struct bowden_biquad_settings_f64 *settings,
                                              struct bowden_about *about);

// Checks the settings and starts a notch. `about` may be null.
bowden_result bowden_biquad_init_notch_f64(struct bowden_biquad_f64 *filter,
                                           const struct bowden_biquad_settings_f64 *settings,
                                           struct bowden_about *about);

// Processes a sample taken `dt` [s] after the last call; `output` receives the
// filtered value.
//
// The first good sample starts the filter at rest. If the sample is not finite, or dt
// is not positive and finite, the last output is held (zero before the first sample):
// BOWDEN_RESULT_HELD.
bowden_result bowden_biquad_step_f64(struct bowden_biquad_f64 *filter,
                                     double sample,
                                     double dt,
                                     double *output);

// Checks the settings and starts a hysteresis. `about` may be null.
bowden_result bowden_hysteresis_init_f32(struct bowden_hysteresis_f32 *hysteresis,
                                         const struct bowden_hysteresis_settings_f32 *settings,
                                         struct bowden_about *about);

// Processes one input [input unit]; `eta` receives the state, within -1 and 1. The
// first sample only sets the input. If the input is not finite, the last result is
// held: BOWDEN_RESULT_HELD.
bowden_result bowden_hysteresis_step_f32(struct bowden_hysteresis_f32 *hysteresis,
                                         float input,
                                         float *eta);

// Checks the parameters and starts a transmission. `about` may be null.
bowden_result bowden_cable_init_f32(struct bowden_cable_f32 *cable,
                                    const struct bowden_cable_settings_f32 *settings,
                                    struct bowden_about *about);

// Processes one input [input unit]; `output` receives the output [output unit]. If the
// input is not finite, the last output is held (zero before the first sample):
// BOWDEN_RESULT_HELD.
bowden_result bowden_cable_step_f32(struct bowden_cable_f32 *cable, float input, float *output);

// Starts the inverse of the transmission with these settings. The result is
// BOWDEN_RESULT_ERROR_INADMISSIBLE if the transmission has no inverse (sigma above
// gain/(2*kappa_eta*rho)).
bowden_result bowden_inverse_init_f32(struct bowden_inverse_f32 *inverse,
                                      const struct bowden_cable_settings_f32 *settings,
                                      struct bowden_about *about);

// One desired output [output unit]: `input` receives the input [input unit] that
// produces it. If the value is not finite, the last result is held:
// BOWDEN_RESULT_HELD.
bowden_result bowden_inverse_step_f32(struct bowden_inverse_f32 *inverse,
                                      float desired,
                                      float *input);

// Checks the settings and starts a hysteresis. `about` may be null.
bowden_result bowden_hysteresis_init_f64(struct bowden_hysteresis_f64 *hysteresis,
                                         const struct bowden_hysteresis_settings_f64 *settings,
                                         struct bowden_about *about);

// Processes one input [input unit]; `eta` receives the state, within -1 and 1. The
// first sample only sets the input. If the input is not finite, the last result is
// held: BOWDEN_RESULT_HELD.
bowden_result bowden_hysteresis_step_f64(struct bowden_hysteresis_f64 *hysteresis,
                                         double input,
                                         double *eta);

// Checks the parameters and starts a transmission. `about` may be null.
bowden_result bowden_cable_init_f64(struct bowden_cable_f64 *cable,
                                    const struct bowden_cable_settings_f64 *settings,
                                    struct bowden_about *about);

// Processes one input [input unit]; `output` receives the output [output unit]. If the
// input is not finite, the last output is held (zero before the first sample):
// BOWDEN_RESULT_HELD.
bowden_result bowden_cable_step_f64(struct bowden_cable_f64 *cable, double input, double *output);

// Starts the inverse of the transmission with these settings. The result is
// BOWDEN_RESULT_ERROR_INADMISSIBLE if the transmission has no inverse (sigma above
// gain/(2*kappa_eta*rho)).
bowden_result bowden_inverse_init_f64(struct bowden_inverse_f64 *inverse,
                                      const struct bowden_cable_settings_f64 *settings,
                                      struct bowden_about *about);

// One desired output [output unit]: `input` receives the input [input unit] that
// produces it. If the value is not finite, the last result is held:
// BOWDEN_RESULT_HELD.
bowden_result bowden_inverse_step_f64(struct bowden_inverse_f64 *inverse,
                                      double desired,
                                      double *input);

// Starts iterative learning over two arrays of `cells` numbers, which it sets to zero.
// `cells` is at least lead + 2*half_width + 9 and at most BOWDEN_CELLS.
//
// The caller owns the arrays. They must exist, and nothing else may write to them, for
// as long as the object is used. Do not use a local array if the object outlives the
// function. Between two calls the caller may read `learned`, to plot or to store it.
// The arrays must not overlap each other or the object
// (BOWDEN_RESULT_ERROR_INADMISSIBLE), and they serve one object at a time. A copy of
// the object uses the same arrays, so use only one of the two.
//
// On an error the object and the arrays do not change. `about` may be null.
bowden_result bowden_iterative_learning_init_f32(struct bowden_iterative_learning_f32 *learning,
                                                 const struct bowden_iterative_learning_settings_f32 *settings,
                                                 float *learned,
                                                 float *unfiltered,
                                                 size_t cells,
                                                 struct bowden_about *about);

// The same as bowden_iterative_learning_init, but with earlier values in `learned`: a
// copy from before a reset, or the array of an object that is no longer used. Values
// are clamped to the limit, and NaN becomes zero. `unfiltered` may have any contents.
bowden_result bowden_iterative_learning_resume_f32(struct bowden_iterative_learning_f32 *learning,
                                                   const struct bowden_iterative_learning_settings_f32 *settings,
                                                   float *learned,
                                                   float *unfiltered,
                                                   size_t cells,
                                                   struct bowden_about *about);

// Processes one sample; call it before the controller's step, with the phase of the
// cycle, from 0 to 1, the reference, and the measured output [output unit]. Set
// `learns` to 0 if a limit has cut the command, the safe command is applied, or the
// task is different. If more than half of a cell's samples have `learns` = 0, the
// errors of the next `lead` cells are ignored too.
//
// A phase outside 0 to 1 changes nothing and holds the feed-forward:
// BOWDEN_RESULT_HELD. The controller counts such samples as good.
// BOWDEN_RESULT_DEGRADED has two causes. If the reference or the measured output is
// not finite, the feed-forward follows the phase, and nothing is learned. If the phase
// has jumped by more than four cells, the cell before the jump does not learn, and the
// feed-forward jumps with the phase. Therefore give the controller a slew-rate limit.
// `out` is written if the result is not negative.
bowden_result bowden_iterative_learning_step_f32(struct bowden_iterative_learning_f32 *learning,
                                                 float phase,
                                                 float reference,
                                                 float measured,
                                                 uint32_t learns,
                                                 struct bowden_iterative_learning_output_f32 *out);

// Starts iterative learning over two arrays of `cells` numbers, which it sets to zero.
// `cells` is at least lead + 2*half_width + 9 and at most BOWDEN_CELLS.
//
// The caller owns the arrays. They must exist, and nothing else may write to them, for
// as long as the object is used. Do not use a local array if the object outlives the
// function. Between two calls the caller may read `learned`, to plot or to store it.
// The arrays must not overlap each other or the object
// (BOWDEN_RESULT_ERROR_INADMISSIBLE), and they serve one object at a time. A copy of
// the object uses the same arrays, so use only one of the two.
//
// On an error the object and the arrays do not change. `about` may be null.
bowden_result bowden_iterative_learning_init_f64(struct bowden_iterative_learning_f64 *learning,
                                                 const struct bowden_iterative_learning_settings_f64 *settings,
                                                 double *learned,
                                                 double *unfiltered,
                                                 size_t cells,
                                                 struct bowden_about *about);

// The same as bowden_iterative_learning_init, but with earlier values in `learned`: a
// copy from before a reset, or the array of an object that is no longer used. Values
// are clamped to the limit, and NaN becomes zero. `unfiltered` may have any contents.
bowden_result bowden_iterative_learning_resume_f64(struct bowden_iterative_learning_f64 *learning,
                                                   const struct bowden_iterative_learning_settings_f64 *settings,
                                                   double *learned,
                                                   double *unfiltered,
                                                   size_t cells,
                                                   struct bowden_about *about);

// Processes one sample; call it before the controller's step, with the phase of the
// cycle, from 0 to 1, the reference, and the measured output [output unit]. Set
// `learns` to 0 if a limit has cut the command, the safe command is applied, or the
// task is different. If more than half of a cell's samples have `learns` = 0, the
// errors of the next `lead` cells are ignored too.
//
// A phase outside 0 to 1 changes nothing and holds the feed-forward:
// BOWDEN_RESULT_HELD. The controller counts such samples as good.
// BOWDEN_RESULT_DEGRADED has two causes. If the reference or the measured output is
// not finite, the feed-forward follows the phase, and nothing is learned. If the phase
// has jumped by more than four cells, the cell before the jump does not learn, and the
// feed-forward jumps with the phase. Therefore give the controller a slew-rate limit.
// `out` is written if the result is not negative.
bowden_result bowden_iterative_learning_step_f64(struct bowden_iterative_learning_f64 *learning,
                                                 double phase,
                                                 double reference,
                                                 double measured,
                                                 uint32_t learns,
                                                 struct bowden_iterative_learning_output_f64 *out);

// Loads a model from the bytes that `bowden identify --model-out FILE.postcard` or
// `bowden export --c` writes, with four bytes of CRC-32 at the end, and starts it.
//
// `length` is the length of the model, not of a larger array or sector: bytes after
// the CRC-32 are refused like damaged bytes. `eta` is the hysteresis state at the
// start, within -1 and 1; 0 if unknown. BOWDEN_RESULT_ERROR_MODEL: the bytes are
// damaged, are too many, have the other precision or another version, or contain more
// than BOWDEN_TERMS terms. `about`, which may be null, is "checksum" for the first
// two. BOWDEN_RESULT_ERROR_CAPACITY: a term reads a channel with a number of
// BOWDEN_CHANNELS or more, or there are more than BOWDEN_MODEL_BYTES bytes. The object
// does not use the bytes afterwards. On an error the object does not change.
bowden_result bowden_model_load_f32(struct bowden_model_f32 *model,
                                    const uint8_t *bytes,
                                    size_t length,
                                    float eta,
                                    struct bowden_about *about);

// Processes one sample; `output` receives the predicted output [output unit]:
//
//     y = transmission(input, eta) + sum of gain*regressor
//
// A bad sample (dt is not positive, a channel is missing, or a number that the model
// reads is not finite) leaves the state unchanged and returns the last good output, 0
// before the first one: BOWDEN_RESULT_HELD.
bowden_result bowden_model_step_f32(struct bowden_model_f32 *model,
                                    const struct bowden_model_sample_f32 *sample,
                                    float *output);

// The hysteresis state, within -1 and 1.
bowden_result bowden_model_eta_f32(const struct bowden_model_f32 *model, float *eta);

// Resets the state to the start, with this hysteresis state.
bowden_result bowden_model_reset_f32(struct bowden_model_f32 *model, float eta);

// Loads a model from the bytes that `bowden identify --model-out FILE.postcard` or
// `bowden export --c` writes, with four bytes of CRC-32 at the end, and starts it.
//
// `length` is the length of the model, not of a larger array or sector: bytes after
// the CRC-32 are refused like damaged bytes. `eta` is the hysteresis state at the
// start, within -1 and 1; 0 if unknown. BOWDEN_RESULT_ERROR_MODEL: the bytes are
// damaged, are too many, have the other precision or another version, or contain more
// than BOWDEN_TERMS terms. `about`, which may be null, is "checksum" for the first
// two. BOWDEN_RESULT_ERROR_CAPACITY: a term reads a channel with a number of
// BOWDEN_CHANNELS or more, or there are more than BOWDEN_MODEL_BYTES bytes. The object
// does not use the bytes afterwards. On an error the object does not change.
bowden_result bowden_model_load_f64(struct bowden_model_f64 *model,
                                    const uint8_t *bytes,
                                    size_t length,
                                    double eta,
                                    struct bowden_about *about);

// Processes one sample; `output` receives the predicted output [output unit]:
//
//     y = transmission(input, eta) + sum of gain*regressor
//
// A bad sample (dt is not positive, a channel is missing, or a number that the model
// reads is not finite) leaves the state unchanged and returns the last good output, 0
// before the first one: BOWDEN_RESULT_HELD.
bowden_result bowden_model_step_f64(struct bowden_model_f64 *model,
                                    const struct bowden_model_sample_f64 *sample,
                                    double *output);

// The hysteresis state, within -1 and 1.
bowden_result bowden_model_eta_f64(const struct bowden_model_f64 *model, double *eta);

// Resets the state to the start, with this hysteresis state.
bowden_result bowden_model_reset_f64(struct bowden_model_f64 *model, double eta);

// Starts an observer. `about` may be null.
bowden_result bowden_observer_init_f32(struct bowden_observer_f32 *observer,
                                       const struct bowden_observer_settings_f32 *settings,
                                       struct bowden_about *about);

// Processes one sample; call it before the controller's step, with `dt` since the last
// call [s], the applied command of the last call after all limits [command unit], and
// the measured output [output unit].
//
// A bad sample holds the estimate: BOWDEN_RESULT_HELD. `out` is written if the result
// is not negative.
bowden_result bowden_observer_step_f32(struct bowden_observer_f32 *observer,
                                       float dt,
                                       float sent,
                                       float measured,
                                       struct bowden_observer_output_f32 *out);

// The command [command unit] for which the nominal plant follows the desired output,
// given with its rates and ahead of time by the latency.
bowden_result bowden_observer_feed_forward_f32(const struct bowden_observer_f32 *observer,
                                               const struct bowden_motion_f32 *wanted,
                                               float *command);

// Resets the state to the start. Call this function after the drive was off, because a
// command that did not reach the motor must not count.
bowden_result bowden_observer_reset_f32(struct bowden_observer_f32 *observer);

// Starts an observer. `about` may be null.
bowden_result bowden_observer_init_f64(struct bowden_observer_f64 *observer,
                                       const struct bowden_observer_settings_f64 *settings,
                                       struct bowden_about *about);

// Processes one sample; call it before the controller's step, with `dt` since the last
// call [s], the applied command of the last call after all limits [command unit], and
// the measured output [output unit].
//
// A bad sample holds the estimate: BOWDEN_RESULT_HELD. `out` is written if the result
// is not negative.
bowden_result bowden_observer_step_f64(struct bowden_observer_f64 *observer,
                                       double dt,
                                       double sent,
                                       double measured,
                                       struct bowden_observer_output_f64 *out);

// The command [command unit] for which the nominal plant follows the desired output,
// given with its rates and ahead of time by the latency.
bowden_result bowden_observer_feed_forward_f64(const struct bowden_observer_f64 *observer,
                                               const struct bowden_motion_f64 *wanted,
                                               double *command);

// Resets the state to the start. Call this function after the drive was off, because a
// command that did not reach the motor must not count.
bowden_result bowden_observer_reset_f64(struct bowden_observer_f64 *observer);

// Settings of a plain PI (15): full set-point weight, conditional anti-windup, and no
// slew-rate limit; 4 good samples cancel a bad one.
//
// `low` and `high` [command unit] are the limits of the drive, `longest_dt` [s] is the
// longest sample time, and `safe` [command unit] is the safe command from the
// `after`-th bad sample in a row on. bowden_pid_init checks the numbers.
bowden_result bowden_pid_settings_pi_f32(struct bowden_pid_settings_f32 *settings,
                                         float k_p,
                                         float k_i,
                                         float low,
                                         float high,
                                         float longest_dt,
                                         uint32_t after,
                                         float safe);

// Checks the settings and starts with a new state.
//
// `about` may be null; otherwise it receives the name of the refused setting. On an
// error the object does not change.
bowden_result bowden_pid_init_f32(struct bowden_pid_f32 *pid,
                                  const struct bowden_pid_settings_f32 *settings,
                                  struct bowden_about *about);

// Processes one sample; `out` receives the command and its status.
//
// A bad sample (NaN, an infinity, a dt that is not positive or too long) leaves the
// state unchanged and holds the last good command: BOWDEN_RESULT_HELD. After too many
// bad samples the safe command is applied until bowden_pid_acknowledge, even if later
// samples are good: BOWDEN_RESULT_SAFE. `out` is written if the result is not
// negative.
bowden_result bowden_pid_step_f32(struct bowden_pid_f32 *pid,
                                  const struct bowden_pid_sample_f32 *sample,
                                  struct bowden_output_f32 *out);

// Every term of the last good sample, for telemetry; all terms are zero before the
// first one.
bowden_result bowden_pid_get_terms_f32(const struct bowden_pid_f32 *pid,
                                       struct bowden_pid_terms_f32 *out);

// Reports the command [command unit] that the drive applied after the last step, if it
// differs from the step's command: a drive that is off applies 0.
//
// Call this function between two steps. The slew-rate limit, anti-windup and a
// bumpless start then continue from this command. A number that is not finite changes
// nothing: BOWDEN_RESULT_HELD.
bowden_result bowden_pid_applied_f32(struct bowden_pid_f32 *pid, float command);

// Reports that the drive was at this limit after the last step: one of
// bowden_saturation. Use it for a drive that does not report its command, such as the
// inner loop of a cascade; otherwise use bowden_pid_applied.
//
// Call this function between two steps. The integral then does not move further
// towards that limit. Any other number returns BOWDEN_RESULT_ERROR_CHOICE.
bowden_result bowden_pid_at_limit_f32(struct bowden_pid_f32 *pid, uint32_t saturation);

// Sets `saturation` to the active limit of the command at the last good sample, one of
// bowden_saturation.
//
// In a cascade whose inner gains are positive, pass it to bowden_pid_at_limit of the
// outer loop.
bowden_result bowden_pid_get_saturation_f32(const struct bowden_pid_f32 *pid, uint32_t *saturation);

// Acknowledges the fault: the next good sample closes the loop again and starts from
// the safe command. Without a latched safe command the call has no effect.
bowden_result bowden_pid_acknowledge_f32(struct bowden_pid_f32 *pid);

// Clears the integral, the rate and the samples. The applied command is kept, and a
// latched safe command stays latched.
bowden_result bowden_pid_reset_f32(struct bowden_pid_f32 *pid);

// Prepares a stored object for a start after a power-off, before its first step: the
// command becomes the value nearest to zero within the limits. The integral, the rate
// and the samples are cleared; a latched safe command stays latched. The first good
// sample starts from this command without a jump. Without this call a step continues
// with the stored command.
bowden_result bowden_pid_restore_f32(struct bowden_pid_f32 *pid);

// Restarts so that the command continues from `command` [command unit] without a jump.
// A number that is not finite counts as a bad sample; a latched safe command stays
// latched. `out` receives the applied command, and may be null.
bowden_result bowden_pid_resume_f32(struct bowden_pid_f32 *pid,
                                    float command,
                                    const struct bowden_pid_sample_f32 *sample,
                                    struct bowden_output_f32 *out);

// Changes the settings of a running loop without a jump of the command. If the new
// range excludes the applied command, the next command is the nearest one in the range
// and ignores the slew-rate limit, so narrow a range step by step. On an error the
// loop continues with the old settings.
bowden_result bowden_pid_change_f32(struct bowden_pid_f32 *pid,
                                    const struct bowden_pid_settings_f32 *settings,
                                    struct bowden_about *about);

// Sets `latched` to 1 while the safe command is latched, otherwise to 0.
bowden_result bowden_pid_is_latched_f32(const struct bowden_pid_f32 *pid, uint32_t *latched);

// Settings of a plain PI (15): full set-point weight, conditional anti-windup, and no
// slew-rate limit; 4 good samples cancel a bad one.
//
// `low` and `high` [command unit] are the limits of the drive, `longest_dt` [s] is the
// longest sample time, and `safe` [command unit] is the safe command from the
// `after`-th bad sample in a row on. bowden_pid_init checks the numbers.
bowden_result bowden_pid_settings_pi_f64(struct bowden_pid_settings_f64 *settings,
                                         double k_p,
                                         double k_i,
                                         double low,
                                         double high,
                                         double longest_dt,
                                         uint32_t after,
                                         double safe);

// Checks the settings and starts with a new state.
//
// `about` may be null; otherwise it receives the name of the refused setting. On an
// error the object does not change.
bowden_result bowden_pid_init_f64(struct bowden_pid_f64 *pid,
                                  const struct bowden_pid_settings_f64 *settings,
                                  struct bowden_about *about);

// Processes one sample; `out` receives the command and its status.
//
// A bad sample (NaN, an infinity, a dt that is not positive or too long) leaves the
// state unchanged and holds the last good command: BOWDEN_RESULT_HELD. After too many
// bad samples the safe command is applied until bowden_pid_acknowledge, even if later
// samples are good: BOWDEN_RESULT_SAFE. `out` is written if the result is not
// negative.
bowden_result bowden_pid_step_f64(struct bowden_pid_f64 *pid,
                                  const struct bowden_pid_sample_f64 *sample,
                                  struct bowden_output_f64 *out);

// Every term of the last good sample, for telemetry; all terms are zero before the
// first one.
bowden_result bowden_pid_get_terms_f64(const struct bowden_pid_f64 *pid,
                                       struct bowden_pid_terms_f64 *out);

// Reports the command [command unit] that the drive applied after the last step, if it
// differs from the step's command: a drive that is off applies 0.
//
// Call this function between two steps. The slew-rate limit, anti-windup and a
// bumpless start then continue from this command. A number that is not finite changes
// nothing: BOWDEN_RESULT_HELD.
bowden_result bowden_pid_applied_f64(struct bowden_pid_f64 *pid, double command);

// Reports that the drive was at this limit after the last step: one of
// bowden_saturation. Use it for a drive that does not report its command, such as the
// inner loop of a cascade; otherwise use bowden_pid_applied.
//
// Call this function between two steps. The integral then does not move further
// towards that limit. Any other number returns BOWDEN_RESULT_ERROR_CHOICE.
bowden_result bowden_pid_at_limit_f64(struct bowden_pid_f64 *pid, uint32_t saturation);

// Sets `saturation` to the active limit of the command at the last good sample, one of
// bowden_saturation.
//
// In a cascade whose inner gains are positive, pass it to bowden_pid_at_limit of the
// outer loop.
bowden_result bowden_pid_get_saturation_f64(const struct bowden_pid_f64 *pid, uint32_t *saturation);

// Acknowledges the fault: the next good sample closes the loop again and starts from
// the safe command. Without a latched safe command the call has no effect.
bowden_result bowden_pid_acknowledge_f64(struct bowden_pid_f64 *pid);

// Clears the integral, the rate and the samples. The applied command is kept, and a
// latched safe command stays latched.
bowden_result bowden_pid_reset_f64(struct bowden_pid_f64 *pid);

// Prepares a stored object for a start after a power-off, before its first step: the
// command becomes the value nearest to zero within the limits. The integral, the rate
// and the samples are cleared; a latched safe command stays latched. The first good
// sample starts from this command without a jump. Without this call a step continues
// with the stored command.
bowden_result bowden_pid_restore_f64(struct bowden_pid_f64 *pid);

// Restarts so that the command continues from `command` [command unit] without a jump.
// A number that is not finite counts as a bad sample; a latched safe command stays
// latched. `out` receives the applied command, and may be null.
bowden_result bowden_pid_resume_f64(struct bowden_pid_f64 *pid,
                                    double command,
                                    const struct bowden_pid_sample_f64 *sample,
                                    struct bowden_output_f64 *out);

// Changes the settings of a running loop without a jump of the command. If the new
// range excludes the applied command, the next command is the nearest one in the range
// and ignores the slew-rate limit, so narrow a range step by step. On an error the
// loop continues with the old settings.
bowden_result bowden_pid_change_f64(struct bowden_pid_f64 *pid,
                                    const struct bowden_pid_settings_f64 *settings,
                                    struct bowden_about *about);

// Sets `latched` to 1 while the safe command is latched, otherwise to 0.
bowden_result bowden_pid_is_latched_f64(const struct bowden_pid_f64 *pid, uint32_t *latched);

// Checks the settings and starts a check of samples. `about` may be null.
bowden_result bowden_plausible_init_f32(struct bowden_plausible_f32 *plausible,
                                        const struct bowden_plausible_settings_f32 *settings,
                                        struct bowden_about *about);

// Checks a sample [signal unit], `dt` [s] after the last call. Set `moves` to 1 while
// the machine moves, so that the signal must change.
//
// BOWDEN_RESULT_IMPLAUSIBLE: the sample is implausible, and the value is NaN. `out` is
// written if the result is not negative.
bowden_result bowden_plausible_step_f32(struct bowden_plausible_f32 *plausible,
                                        float sample,
                                        float dt,
                                        uint32_t moves,
                                        struct bowden_plausible_output_f32 *out);

// Checks the settings and starts a check of samples. `about` may be null.
bowden_result bowden_plausible_init_f64(struct bowden_plausible_f64 *plausible,
                                        const struct bowden_plausible_settings_f64 *settings,
                                        struct bowden_about *about);

// Checks a sample [signal unit], `dt` [s] after the last call. Set `moves` to 1 while
// the machine moves, so that the signal must change.
//
// BOWDEN_RESULT_IMPLAUSIBLE: the sample is implausible, and the value is NaN. `out` is
// written if the result is not negative.
bowden_result bowden_plausible_step_f64(struct bowden_plausible_f64 *plausible,
                                        double sample,
                                        double dt,
                                        uint32_t moves,
                                        struct bowden_plausible_output_f64 *out);

// Starts a play with a `half_width` of at least zero [input unit], see
// bowden_play_step. At zero the output is the input. `about` may be null.
bowden_result bowden_play_init_f32(struct bowden_play_f32 *play,
                                   float half_width,
                                   struct bowden_about *about);

// Processes one input [input unit]; `output` receives the last output, moved by the
// least amount that keeps it within the half-width r of the input:
//
//     y+ = clamp(y, x - r, x + r)
//
// An oscillation of the input within 2*r does not move the output. In front of a
// hysteresis a play prevents reversals from sensor noise. The first good sample is
// passed on unchanged. If the input is not finite, the last output is held (zero
// before the first sample): BOWDEN_RESULT_HELD.
bowden_result bowden_play_step_f32(struct bowden_play_f32 *play, float input, float *output);

// Starts a play with a `half_width` of at least zero [input unit], see
// bowden_play_step. At zero the output is the input. `about` may be null.
bowden_result bowden_play_init_f64(struct bowden_play_f64 *play,
                                   double half_width,
                                   struct bowden_about *about);

// Processes one input [input unit]; `output` receives the last output, moved by the
// least amount that keeps it within the half-width r of the input:
//
//     y+ = clamp(y, x - r, x + r)
//
// An oscillation of the input within 2*r does not move the output. In front of a
// hysteresis a play prevents reversals from sensor noise. The first good sample is
// passed on unchanged. If the input is not finite, the last output is held (zero
// before the first sample): BOWDEN_RESULT_HELD.
bowden_result bowden_play_step_f64(struct bowden_play_f64 *play, double input, double *output);

// Checks the settings and starts rates. `about` may be null.
bowden_result bowden_rates_init_f32(struct bowden_rates_f32 *rates,
                                    const struct bowden_rates_settings_f32 *settings,
                                    struct bowden_about *about);

// The motion at a position [channel unit], `dt` [s] after the last call, whether that
// sample was good or bad:
//
//     s  = 1 - exp(-h/tau),  h = time since the last good sample
//     v+ = v + s*((x - x_last)/h - v)
//     a+ = a + s*((v+ - v)/h - a)
//
// A bad sample holds the last good motion: BOWDEN_RESULT_HELD. `out` is written if the
// result is not negative.
bowden_result bowden_rates_step_f32(struct bowden_rates_f32 *rates,
                                    float position,
                                    float dt,
                                    struct bowden_rates_output_f32 *out);

// Checks the settings and starts rates. `about` may be null.
bowden_result bowden_rates_init_f64(struct bowden_rates_f64 *rates,
                                    const struct bowden_rates_settings_f64 *settings,
                                    struct bowden_about *about);

// The motion at a position [channel unit], `dt` [s] after the last call, whether that
// sample was good or bad:
//
//     s  = 1 - exp(-h/tau),  h = time since the last good sample
//     v+ = v + s*((x - x_last)/h - v)
//     a+ = a + s*((v+ - v)/h - a)
//
// A bad sample holds the last good motion: BOWDEN_RESULT_HELD. `out` is written if the
// result is not negative.
bowden_result bowden_rates_step_f64(struct bowden_rates_f64 *rates,
                                    double position,
                                    double dt,
                                    struct bowden_rates_output_f64 *out);

// Checks the settings and starts an experiment. `about` may be null.
//
// Start with the output near the reference: at the mean command of the previous loop,
// or at rest.
bowden_result bowden_relay_init_f32(struct bowden_relay_f32 *relay,
                                    const struct bowden_relay_settings_f32 *settings,
                                    struct bowden_about *about);

// Processes one sample, with `dt` since the last call [s], also after a bad sample,
// and the measured output [output unit]. Call this function while the phase is
// BOWDEN_RELAY_PHASE_RUNNING.
//
// A bad sample holds the command: BOWDEN_RESULT_HELD. After a failure the safe command
// is applied until bowden_relay_acknowledge: BOWDEN_RESULT_SAFE. Every sample consumes
// part of `longest_time`, so the experiment ends. `out` is written if the result is
// not negative.
bowden_result bowden_relay_step_f32(struct bowden_relay_f32 *relay,
                                    float dt,
                                    float measured,
                                    struct bowden_relay_output_f32 *out);

// Acknowledges the failure: the next good sample restarts the experiment with its full
// duration. Without a failure the call has no effect.
bowden_result bowden_relay_acknowledge_f32(struct bowden_relay_f32 *relay);

// Sets `latched` to 1 while the safe command is latched, otherwise to 0.
bowden_result bowden_relay_is_latched_f32(const struct bowden_relay_f32 *relay, uint32_t *latched);

// The gains of a PI by `rule`, one of bowden_pi_rule, from the result of an experiment.
//
// Continue with bowden_pid_resume from the applied command. An unknown rule returns
// BOWDEN_RESULT_ERROR_CHOICE. A result that is zero or not finite, as before the end
// of the experiment, returns BOWDEN_RESULT_ERROR_OUT_OF_RANGE.
bowden_result bowden_relay_gains_f32(const struct bowden_ultimate_f32 *ultimate,
                                     uint32_t rule,
                                     struct bowden_pi_gains_f32 *gains);

// Checks the settings and starts an experiment. `about` may be null.
//
// Start with the output near the reference: at the mean command of the previous loop,
// or at rest.
bowden_result bowden_relay_init_f64(struct bowden_relay_f64 *relay,
                                    const struct bowden_relay_settings_f64 *settings,
                                    struct bowden_about *about);

// Processes one sample, with `dt` since the last call [s], also after a bad sample,
// and the measured output [output unit]. Call this function while the phase is
// BOWDEN_RELAY_PHASE_RUNNING.
//
// A bad sample holds the command: BOWDEN_RESULT_HELD. After a failure the safe command
// is applied until bowden_relay_acknowledge: BOWDEN_RESULT_SAFE. Every sample consumes
// part of `longest_time`, so the experiment ends. `out` is written if the result is
// not negative.
bowden_result bowden_relay_step_f64(struct bowden_relay_f64 *relay,
                                    double dt,
                                    double measured,
                                    struct bowden_relay_output_f64 *out);

// Acknowledges the failure: the next good sample restarts the experiment with its full
// duration. Without a failure the call has no effect.
bowden_result bowden_relay_acknowledge_f64(struct bowden_relay_f64 *relay);

// Sets `latched` to 1 while the safe command is latched, otherwise to 0.
bowden_result bowden_relay_is_latched_f64(const struct bowden_relay_f64 *relay, uint32_t *latched);

// The gains of a PI by `rule`, one of bowden_pi_rule, from the result of an experiment.
//
// Continue with bowden_pid_resume from the applied command. An unknown rule returns
// BOWDEN_RESULT_ERROR_CHOICE. A result that is zero or not finite, as before the end
// of the experiment, returns BOWDEN_RESULT_ERROR_OUT_OF_RANGE.
bowden_result bowden_relay_gains_f64(const struct bowden_ultimate_f64 *ultimate,
                                     uint32_t rule,
                                     struct bowden_pi_gains_f64 *gains);

// A sentence about a result, for a log: ASCII, static, and never null, even for an unknown number.
const char *bowden_result_text(int32_t result);

// The bad input of a sample, for a log: ASCII, static, and never null.
const char *bowden_fault_text(int32_t fault);

// The version of the library, such as "0.2.0": static, and never null.
const char *bowden_version(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* BOWDEN_H */

#ifndef BOWDEN_SIZES
#define BOWDEN_SIZES
/* What the library was built with; an array of negative size where the compiler differs. */
#define BOWDEN_ASSERT_SIZE(type, words) \
    typedef char bowden_assert_##type[sizeof(type) == 8 * (words) ? 1 : -1]
BOWDEN_ASSERT_SIZE(bowden_pid_f32, BOWDEN_PID_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_pid_f64, BOWDEN_PID_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_hysteresis_f32, BOWDEN_HYSTERESIS_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_hysteresis_f64, BOWDEN_HYSTERESIS_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_cable_f32, BOWDEN_CABLE_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_cable_f64, BOWDEN_CABLE_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_inverse_f32, BOWDEN_INVERSE_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_inverse_f64, BOWDEN_INVERSE_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_rates_f32, BOWDEN_RATES_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_rates_f64, BOWDEN_RATES_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_observer_f32, BOWDEN_OBSERVER_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_observer_f64, BOWDEN_OBSERVER_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_iterative_learning_f32, BOWDEN_ITERATIVE_LEARNING_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_iterative_learning_f64, BOWDEN_ITERATIVE_LEARNING_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_play_f32, BOWDEN_PLAY_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_play_f64, BOWDEN_PLAY_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_low_pass_f32, BOWDEN_LOW_PASS_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_low_pass_f64, BOWDEN_LOW_PASS_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_biquad_f32, BOWDEN_BIQUAD_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_biquad_f64, BOWDEN_BIQUAD_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_edge_velocity_f32, BOWDEN_EDGE_VELOCITY_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_edge_velocity_f64, BOWDEN_EDGE_VELOCITY_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_plausible_f32, BOWDEN_PLAUSIBLE_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_plausible_f64, BOWDEN_PLAUSIBLE_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_relay_f32, BOWDEN_RELAY_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_relay_f64, BOWDEN_RELAY_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_adaptive_f32, BOWDEN_ADAPTIVE_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_adaptive_f64, BOWDEN_ADAPTIVE_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_model_f32, BOWDEN_MODEL_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_model_f64, BOWDEN_MODEL_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_compensator_f32, BOWDEN_COMPENSATOR_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_compensator_f64, BOWDEN_COMPENSATOR_F64_WORDS);
#undef BOWDEN_ASSERT_SIZE
#endif /* BOWDEN_SIZES */
