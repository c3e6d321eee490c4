/* bowden: hysteretic cable transmissions and their control. Made by `cargo xtask header` from
 * the sources in capi/src; do not edit. C99, C++11.
 *
 * Every function is there for float and for double: NAME_f32 and NAME_f64.
 *
 * Memory. Nothing is allocated. An object (bowden_pid_f32, ...) is a struct of the caller: static,
 * on the stack, in another struct. NAME_init checks the settings and makes it usable; it may be
 * copied and moved as a whole, and needs no end. Every other function on an object that was not
 * initialised gives BOWDEN_RESULT_ERROR_UNINITIALISED. The arrays of a bowden_learning_f32 are the
 * caller's too, and stay where they are for as long as it is used.
 *
 * Pointers. A pointer is null or leads to memory of its type. Null and misaligned ones are told,
 * others cannot be. No object is used from two threads, or from a task and its interrupt, at once.
 *
 * Results. 0: all well. Above 0: a sample was not a good one; what was asked for is written all the
 * same. Below 0: nothing was done and nothing was written. Test for `< 0`, and look at which.
 *
 * Bad samples. A NaN or an infinity in a measurement, in the reference or in dt, or a dt that is
 * not positive or too long, leaves the state as it was and holds the last good command. After too
 * many the safe command is out, good samples or not, until it is acknowledged. The command is
 * finite and within the limits in every case.
 *
 * Numbers in brackets, such as (14), are the equations of the paper on torque control of
 * cable-conduit mechanisms that the project started from. Units stand in square brackets. */


#ifndef BOWDEN_H
#define BOWDEN_H

#include <stddef.h>
#include <stdint.h>

// Most regressors of an adaptive law.
#define BOWDEN_REGRESSORS 4

// Room of a bowden_adaptive_f32, in words of 64 bits.
#define BOWDEN_ADAPTIVE_F32_WORDS 56

// Room of a bowden_adaptive_f64, in words of 64 bits.
#define BOWDEN_ADAPTIVE_F64_WORDS 104

// Most ranges of a compensator.
#define BOWDEN_RANGES 17

// As the source of a range: the transmission's input.
#define BOWDEN_SOURCE_INPUT 4294967295

// Room of a bowden_compensator_f32, in words of 64 bits.
#define BOWDEN_COMPENSATOR_F32_WORDS 184

// Room of a bowden_compensator_f64, in words of 64 bits.
#define BOWDEN_COMPENSATOR_F64_WORDS 360

// Room of a bowden_hysteresis_f32, in words of 64 bits.
#define BOWDEN_HYSTERESIS_F32_WORDS 8

// Room of a bowden_hysteresis_f64, in words of 64 bits.
#define BOWDEN_HYSTERESIS_F64_WORDS 14

// Room of a bowden_cable_f32, in words of 64 bits.
#define BOWDEN_CABLE_F32_WORDS 10

// Room of a bowden_cable_f64, in words of 64 bits.
#define BOWDEN_CABLE_F64_WORDS 20

// Room of a bowden_inverse_f32, in words of 64 bits.
#define BOWDEN_INVERSE_F32_WORDS 10

// Room of a bowden_inverse_f64, in words of 64 bits.
#define BOWDEN_INVERSE_F64_WORDS 20

// Most cells of a cycle.
#define BOWDEN_CELLS 65535

// Room of a bowden_learning_f32, in words of 64 bits.
#define BOWDEN_LEARNING_F32_WORDS 14

// Room of a bowden_learning_f64, in words of 64 bits.
#define BOWDEN_LEARNING_F64_WORDS 18

// Most terms of a model.
#define BOWDEN_TERMS 16

// Most channels of a sample.
#define BOWDEN_CHANNELS 16

// Most bytes of a model: more than any with BOWDEN_TERMS terms has.
#define BOWDEN_MODEL_BYTES 2048

// Room of a bowden_model_f32, in words of 64 bits.
#define BOWDEN_MODEL_F32_WORDS 112

// Room of a bowden_model_f64, in words of 64 bits.
#define BOWDEN_MODEL_F64_WORDS 216

// Room of a bowden_observer_f32, in words of 64 bits.
#define BOWDEN_OBSERVER_F32_WORDS 14

// Room of a bowden_observer_f64, in words of 64 bits.
#define BOWDEN_OBSERVER_F64_WORDS 25

// For `after` of a fallback: the last good command is held for ever; for a simulation, not for
// a machine.
#define BOWDEN_HOLD_FOR_EVER 4294967295

// Room of a bowden_pid_f32, in words of 64 bits.
#define BOWDEN_PID_F32_WORDS 24

// Room of a bowden_pid_f64, in words of 64 bits.
#define BOWDEN_PID_F64_WORDS 40

// Room of a bowden_play_f32, in words of 64 bits.
#define BOWDEN_PLAY_F32_WORDS 4

// Room of a bowden_play_f64, in words of 64 bits.
#define BOWDEN_PLAY_F64_WORDS 6

// Room of a bowden_rates_f32, in words of 64 bits.
#define BOWDEN_RATES_F32_WORDS 10

// Room of a bowden_rates_f64, in words of 64 bits.
#define BOWDEN_RATES_F64_WORDS 16

// What a function did: 0 for all well, above zero where a sample was not a good one and what
// was asked for was written all the same, below zero where nothing was done or written.
enum bowden_result
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // All well; of a step: a good sample.
    BOWDEN_RESULT_OK = 0,
    // Rates: a good sample, but the rates started from zero less than five time constants ago.
    BOWDEN_RESULT_SETTLING = 1,
    // Rates: a good position after a time that is unknown; the rates are held.
    BOWDEN_RESULT_RESUMED = 2,
    // A regressor was bad and its term was left out; the loop is closed, the estimates wait. Of a
    // learning: the feed-forward is of this phase, but an error was not learned from, that of the
    // sample or that of the cell that was left.
    BOWDEN_RESULT_DEGRADED = 3,
    // A bad sample: the state is as it was, the last good command or value is held.
    BOWDEN_RESULT_HELD = 4,
    // Too many bad samples: the safe command is out until it is acknowledged.
    BOWDEN_RESULT_SAFE = 5,
    // A pointer is null.
    BOWDEN_RESULT_ERROR_NULL = -1,
    // A pointer is not aligned as its type must be.
    BOWDEN_RESULT_ERROR_MISALIGNED = -2,
    // The object was not initialised, or something has written over it.
    BOWDEN_RESULT_ERROR_UNINITIALISED = -3,
    // A setting is NaN or infinite.
    BOWDEN_RESULT_ERROR_NON_FINITE = -4,
    // A setting is outside of its range.
    BOWDEN_RESULT_ERROR_OUT_OF_RANGE = -5,
    // Two settings break a condition together.
    BOWDEN_RESULT_ERROR_INADMISSIBLE = -6,
    // More items than there is room for.
    BOWDEN_RESULT_ERROR_CAPACITY = -7,
    // A setting that is one of an enum has a value that the enum has not.
    BOWDEN_RESULT_ERROR_CHOICE = -8,
    // The bytes of a model are damaged, too many, of the other precision or version, or of too
    // many terms.
    BOWDEN_RESULT_ERROR_MODEL = -9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_result bowden_result;
#else
typedef int32_t bowden_result;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What was wrong with a sample.
enum bowden_fault
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Nothing.
    BOWDEN_FAULT_NONE = 0,
    // dt is NaN or infinite.
    BOWDEN_FAULT_DT = 1,
    // dt is zero or negative: time has not moved on.
    BOWDEN_FAULT_DT_NOT_POSITIVE = 2,
    // dt is longer than the longest that was stated, or than the law is stable for.
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
    // A regressor, or what a term of a model reads; which one stands beside it.
    BOWDEN_FAULT_REGRESSOR = 9,
    // Every input is finite, but the command could not be computed: an overflow.
    BOWDEN_FAULT_OVERFLOW = 10,
    // The position.
    BOWDEN_FAULT_POSITION = 11,
    // Another one, of a later version.
    BOWDEN_FAULT_OTHER = 12,
    // The phase of a cycle is not from 0 to 1, or has jumped.
    BOWDEN_FAULT_PHASE = 13,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_fault bowden_fault;
#else
typedef int32_t bowden_fault;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What the gain `k_d` multiplies.
enum bowden_damping
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The filtered derivative of y - c*y_r, PID (14).
    BOWDEN_DAMPING_RATE = 0,
    // The measured distal velocity as it is, PIV (16); nothing is filtered.
    BOWDEN_DAMPING_VELOCITY = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_damping bowden_damping;
#else
typedef uint32_t bowden_damping;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What keeps the integral from growing while the command is limited.
enum bowden_anti_windup
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // The integral does not grow in the direction in which the limit is passed.
    BOWDEN_ANTI_WINDUP_CONDITIONAL = 0,
    // Nothing: the integral winds up.
    BOWDEN_ANTI_WINDUP_NONE = 1,
    // The integral term stays within the range of the command, widened to hold zero.
    BOWDEN_ANTI_WINDUP_CLAMP = 2,
    // What the limits cut off flows back into the integral, over `tracking_time`.
    BOWDEN_ANTI_WINDUP_BACK_CALCULATION = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_anti_windup bowden_anti_windup;
#else
typedef uint32_t bowden_anti_windup;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What is transmitted.
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

// How the error's rate enters the law: each form is for one kind of plant.
enum bowden_form
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // (23) as it stands, with a filtered difference of the error: for a plant with inertia.
    BOWDEN_FORM_LITERAL = 0,
    // The error's rate solved for: for a plant that answers within a sample.
    BOWDEN_FORM_LAG = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_form bowden_form;
#else
typedef uint32_t bowden_form;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Which smooth sign stands in (23) and (25).
enum bowden_smooth_sign
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // tanh(x), as the paper has it.
    BOWDEN_SMOOTH_SIGN_TANH = 0,
    // x within [-1, 1]: cheaper, and leaves less.
    BOWDEN_SMOOTH_SIGN_CLAMP = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_smooth_sign bowden_smooth_sign;
#else
typedef uint32_t bowden_smooth_sign;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How an estimate leaks back to its prior.
enum bowden_leakage
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Not at all: the box alone holds the estimate.
    BOWDEN_LEAKAGE_NONE = 0,
    // At `leakage_rate` always: the sigma of (24)-(26).
    BOWDEN_LEAKAGE_CONSTANT = 1,
    // Only where it is further than `leakage_bound` from its prior; at twice that, at
    // `leakage_rate`.
    BOWDEN_LEAKAGE_SWITCHING = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_leakage bowden_leakage;
#else
typedef uint32_t bowden_leakage;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a regressor that is not finite does.
enum bowden_missing
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // A bad sample: the command is held.
    BOWDEN_MISSING_HOLD = 0,
    // Its term is left out, the estimates wait, the loop stays closed:
    // BOWDEN_RESULT_DEGRADED.
    BOWDEN_MISSING_DROP = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum bowden_missing bowden_missing;
#else
typedef uint32_t bowden_missing;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How one estimate adapts, (24)-(26), with a box.
typedef struct bowden_estimator_f32 {
    // Where the estimate starts [unit of the estimate], within the box.
    float initial;
    // Least value [unit of the estimate].
    float low;
    // Greatest value [unit of the estimate].
    float high;
    // Adaptation gain: gamma, mu or mu_i of (24)-(26), not negative.
    float gain;
    // What the leakage pulls to [unit of the estimate]; 0 in the paper.
    float prior;
    // One of bowden_leakage.
    uint32_t leakage;
    // Greatest leakage, not negative [1/s].
    float leakage_rate;
    // Of BOWDEN_LEAKAGE_SWITCHING alone, above zero [unit of the estimate].
    float leakage_bound;
} bowden_estimator_f32;

// Range and slew rate of a command.
typedef struct bowden_limits_f32 {
    // Least command [command unit].
    float low;
    // Greatest command [command unit]; above `low`.
    float high;
    // Slew rate above zero [command unit/s]; 0 for none.
    float slew;
} bowden_limits_f32;

// What to command when samples stay bad.
//
// A score counts: a bad sample adds the weight, a good one takes 1 away. At
// after*weight the safe command goes out and stays out until it is acknowledged.
typedef struct bowden_fallback_f32 {
    // From which bad sample in a row on, at least 1; BOWDEN_HOLD_FOR_EVER for never.
    uint32_t after;
    // How many good samples make up for a bad one, at least 1; 4 is usual.
    uint32_t weight;
    // The safe command [command unit], within the limits.
    float command;
} bowden_fallback_f32;

// Settings of the adaptive law, (17)-(26).
typedef struct bowden_adaptive_settings_f32 {
    // One of bowden_form.
    uint32_t form;
    // Of the literal form: filter of the error's rate, 2 to 20 ms [s].
    float time_constant;
    // Of the lag form: longest sample time that is intended [s].
    float step;
    // Of the lag form: upper bound of the plant's gain alpha [N*m/command unit].
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
    // Estimate of the bound of the disturbance [N*m], (25).
    struct bowden_estimator_f32 delta;
    // How many regressors there are, at most BOWDEN_REGRESSORS.
    uint32_t regressors;
    // Estimates of theta_i [N*m/unit of the regressor], (26); those from
    // `regressors` on are not read.
    struct bowden_estimator_f32 theta[BOWDEN_REGRESSORS];
    // One of bowden_missing for each regressor.
    uint32_t missing[BOWDEN_REGRESSORS];
    // Most that the accumulated error z may be, above zero [N*m*s].
    float z_limit;
    // 0, or anything else where the estimates stay as they are.
    uint32_t frozen;
    // Range and slew rate of the command.
    struct bowden_limits_f32 limits;
    // Longest dt that is a sample, above zero [s]; the lag form accepts none longer
    // than 1/(lambda*max(1, g*(k + delta.high/epsilon))) either.
    float longest_dt;
    // What goes out when samples stay bad.
    struct bowden_fallback_f32 fallback;
} bowden_adaptive_settings_f32;

// An adaptive law with its state; the caller's memory, made by
// bowden_adaptive_init.
typedef struct bowden_adaptive_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_ADAPTIVE_F32_WORDS];
} bowden_adaptive_f32;

// The name of the setting that was refused, or the condition that is not met.
typedef struct bowden_about {
    // ASCII with a NUL behind it, such as "k_p" or "low < high"; cut off where it is longer.
    char text[128];
} bowden_about;

// One sample for the adaptive law.
typedef struct bowden_adaptive_sample_f32 {
    // Since the last call, also where that was a bad sample [s].
    float dt;
    // Reference y_r [N*m].
    float reference;
    // Reference at the next sample [N*m]; only the lag form reads it.
    float next_reference;
    // Measured output torque y [N*m].
    float measured;
    // Regressors x_i [their own units]: velocity and acceleration in the paper.
    // Those beyond the law's number are not read.
    float regressors[BOWDEN_REGRESSORS];
    // Added to the law's command [command unit]; 0 for none.
    float feed_forward;
} bowden_adaptive_sample_f32;

// What a step of a controller gives.
typedef struct bowden_output_f32 {
    // What goes to the drive [command unit]: finite and within the limits.
    float command;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
    // Which regressor or term, from 0, where the fault is BOWDEN_FAULT_REGRESSOR.
    uint32_t regressor;
} bowden_output_f32;

// What the law has estimated.
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

// How one estimate adapts, (24)-(26), with a box.
typedef struct bowden_estimator_f64 {
    // Where the estimate starts [unit of the estimate], within the box.
    double initial;
    // Least value [unit of the estimate].
    double low;
    // Greatest value [unit of the estimate].
    double high;
    // Adaptation gain: gamma, mu or mu_i of (24)-(26), not negative.
    double gain;
    // What the leakage pulls to [unit of the estimate]; 0 in the paper.
    double prior;
    // One of bowden_leakage.
    uint32_t leakage;
    // Greatest leakage, not negative [1/s].
    double leakage_rate;
    // Of BOWDEN_LEAKAGE_SWITCHING alone, above zero [unit of the estimate].
    double leakage_bound;
} bowden_estimator_f64;

// Range and slew rate of a command.
typedef struct bowden_limits_f64 {
    // Least command [command unit].
    double low;
    // Greatest command [command unit]; above `low`.
    double high;
    // Slew rate above zero [command unit/s]; 0 for none.
    double slew;
} bowden_limits_f64;

// What to command when samples stay bad.
//
// A score counts: a bad sample adds the weight, a good one takes 1 away. At
// after*weight the safe command goes out and stays out until it is acknowledged.
typedef struct bowden_fallback_f64 {
    // From which bad sample in a row on, at least 1; BOWDEN_HOLD_FOR_EVER for never.
    uint32_t after;
    // How many good samples make up for a bad one, at least 1; 4 is usual.
    uint32_t weight;
    // The safe command [command unit], within the limits.
    double command;
} bowden_fallback_f64;

// Settings of the adaptive law, (17)-(26).
typedef struct bowden_adaptive_settings_f64 {
    // One of bowden_form.
    uint32_t form;
    // Of the literal form: filter of the error's rate, 2 to 20 ms [s].
    double time_constant;
    // Of the lag form: longest sample time that is intended [s].
    double step;
    // Of the lag form: upper bound of the plant's gain alpha [N*m/command unit].
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
    // Estimate of the bound of the disturbance [N*m], (25).
    struct bowden_estimator_f64 delta;
    // How many regressors there are, at most BOWDEN_REGRESSORS.
    uint32_t regressors;
    // Estimates of theta_i [N*m/unit of the regressor], (26); those from
    // `regressors` on are not read.
    struct bowden_estimator_f64 theta[BOWDEN_REGRESSORS];
    // One of bowden_missing for each regressor.
    uint32_t missing[BOWDEN_REGRESSORS];
    // Most that the accumulated error z may be, above zero [N*m*s].
    double z_limit;
    // 0, or anything else where the estimates stay as they are.
    uint32_t frozen;
    // Range and slew rate of the command.
    struct bowden_limits_f64 limits;
    // Longest dt that is a sample, above zero [s]; the lag form accepts none longer
    // than 1/(lambda*max(1, g*(k + delta.high/epsilon))) either.
    double longest_dt;
    // What goes out when samples stay bad.
    struct bowden_fallback_f64 fallback;
} bowden_adaptive_settings_f64;

// An adaptive law with its state; the caller's memory, made by
// bowden_adaptive_init.
typedef struct bowden_adaptive_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_ADAPTIVE_F64_WORDS];
} bowden_adaptive_f64;

// One sample for the adaptive law.
typedef struct bowden_adaptive_sample_f64 {
    // Since the last call, also where that was a bad sample [s].
    double dt;
    // Reference y_r [N*m].
    double reference;
    // Reference at the next sample [N*m]; only the lag form reads it.
    double next_reference;
    // Measured output torque y [N*m].
    double measured;
    // Regressors x_i [their own units]: velocity and acceleration in the paper.
    // Those beyond the law's number are not read.
    double regressors[BOWDEN_REGRESSORS];
    // Added to the law's command [command unit]; 0 for none.
    double feed_forward;
} bowden_adaptive_sample_f64;

// What a step of a controller gives.
typedef struct bowden_output_f64 {
    // What goes to the drive [command unit]: finite and within the limits.
    double command;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
    // Which regressor or term, from 0, where the fault is BOWDEN_FAULT_REGRESSOR.
    uint32_t regressor;
} bowden_output_f64;

// What the law has estimated.
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

// A model turned round, with its state; the caller's memory, made by
// bowden_compensator_init.
typedef struct bowden_compensator_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_COMPENSATOR_F32_WORDS];
} bowden_compensator_f32;

// An identified model with its state; the caller's memory, made by
// bowden_model_load.
typedef struct bowden_model_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_MODEL_F32_WORDS];
} bowden_model_f32;

// Position, velocity and acceleration of one channel, in its own units and seconds.
typedef struct bowden_motion_f32 {
    // [channel unit]
    float position;
    // [channel unit/s]
    float velocity;
    // [channel unit/s^2]
    float acceleration;
} bowden_motion_f32;

// What the bench has seen of one source: the effects are not asked beyond it.
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
    // Since the previous sample, above zero [s].
    float dt;
    // The output that is wanted [output unit], such as tau_o [N*m]: the reference,
    // not the measured output.
    float desired;
    // The transmission's input with its rates, as it is now, for effects that read
    // it.
    struct bowden_motion_f32 input;
    // The transmitted load: tau_i in torque mode, else a load channel.
    float load;
    // All other channels, in the order of the model's file; may be null where
    // there are none.
    const struct bowden_motion_f32 *channels;
    // How many there are, at most BOWDEN_CHANNELS.
    size_t channel_count;
} bowden_compensator_sample_f32;

// What a step of a compensator gives.
typedef struct bowden_compensator_output_f32 {
    // The transmission's input [input unit], such as tau_i [N*m]; finite.
    float command;
    // Share of the effects in the output [output unit], zero on a bad sample.
    float effects;
    // The model's hysteresis state, within -1 and 1.
    float eta;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
    // Which term, from 0, where the fault is BOWDEN_FAULT_REGRESSOR.
    uint32_t regressor;
} bowden_compensator_output_f32;

// A model turned round, with its state; the caller's memory, made by
// bowden_compensator_init.
typedef struct bowden_compensator_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_COMPENSATOR_F64_WORDS];
} bowden_compensator_f64;

// An identified model with its state; the caller's memory, made by
// bowden_model_load.
typedef struct bowden_model_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_MODEL_F64_WORDS];
} bowden_model_f64;

// Position, velocity and acceleration of one channel, in its own units and seconds.
typedef struct bowden_motion_f64 {
    // [channel unit]
    double position;
    // [channel unit/s]
    double velocity;
    // [channel unit/s^2]
    double acceleration;
} bowden_motion_f64;

// What the bench has seen of one source: the effects are not asked beyond it.
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
    // Since the previous sample, above zero [s].
    double dt;
    // The output that is wanted [output unit], such as tau_o [N*m]: the reference,
    // not the measured output.
    double desired;
    // The transmission's input with its rates, as it is now, for effects that read
    // it.
    struct bowden_motion_f64 input;
    // The transmitted load: tau_i in torque mode, else a load channel.
    double load;
    // All other channels, in the order of the model's file; may be null where
    // there are none.
    const struct bowden_motion_f64 *channels;
    // How many there are, at most BOWDEN_CHANNELS.
    size_t channel_count;
} bowden_compensator_sample_f64;

// What a step of a compensator gives.
typedef struct bowden_compensator_output_f64 {
    // The transmission's input [input unit], such as tau_i [N*m]; finite.
    double command;
    // Share of the effects in the output [output unit], zero on a bad sample.
    double effects;
    // The model's hysteresis state, within -1 and 1.
    double eta;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
    // Which term, from 0, where the fault is BOWDEN_FAULT_REGRESSOR.
    uint32_t regressor;
} bowden_compensator_output_f64;

// The hysteresis (2), (7) with its state; made by bowden_hysteresis_init.
typedef struct bowden_hysteresis_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_HYSTERESIS_F32_WORDS];
} bowden_hysteresis_f32;

// A transmission (1), (5) with its state; made by bowden_cable_init.
typedef struct bowden_cable_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_CABLE_F32_WORDS];
} bowden_cable_f32;

// The transmission's figures, (1), (2), (5), (7).
typedef struct bowden_cable_settings_f32 {
    // One of bowden_mode.
    uint32_t mode;
    // B of (5) or kappa of (1) [output unit/input unit].
    float gain;
    // Share of the hysteresis [output unit].
    float kappa_eta;
    // T0 of (5) or the offset of (1) [output unit].
    float offset;
    // Above zero [1/input unit].
    float rho;
    // At least 1/2.
    float sigma;
    // At least 1.
    float n;
    // The hysteresis state at the start, within -1 and 1; 0 where it is not known.
    float eta;
} bowden_cable_settings_f32;

// The inverse (6) of a transmission, with its state; made by bowden_inverse_init.
typedef struct bowden_inverse_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_INVERSE_F32_WORDS];
} bowden_inverse_f32;

// The hysteresis (2), (7) with its state; made by bowden_hysteresis_init.
typedef struct bowden_hysteresis_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_HYSTERESIS_F64_WORDS];
} bowden_hysteresis_f64;

// A transmission (1), (5) with its state; made by bowden_cable_init.
typedef struct bowden_cable_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_CABLE_F64_WORDS];
} bowden_cable_f64;

// The transmission's figures, (1), (2), (5), (7).
typedef struct bowden_cable_settings_f64 {
    // One of bowden_mode.
    uint32_t mode;
    // B of (5) or kappa of (1) [output unit/input unit].
    double gain;
    // Share of the hysteresis [output unit].
    double kappa_eta;
    // T0 of (5) or the offset of (1) [output unit].
    double offset;
    // Above zero [1/input unit].
    double rho;
    // At least 1/2.
    double sigma;
    // At least 1.
    double n;
    // The hysteresis state at the start, within -1 and 1; 0 where it is not known.
    double eta;
} bowden_cable_settings_f64;

// The inverse (6) of a transmission, with its state; made by bowden_inverse_init.
typedef struct bowden_inverse_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_INVERSE_F64_WORDS];
} bowden_inverse_f64;

// A learning with its state but for two arrays of the caller; made by
// bowden_learning_init or bowden_learning_resume.
typedef struct bowden_learning_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_LEARNING_F32_WORDS];
} bowden_learning_f32;

// Settings of a learning. A cycle is divided into cells of equal phase; with e the mean
// of reference - measured over a cell, and w(k) a triangle of area 1:
//
//     v(c) = (1 - forgetting)*learned(c) + gain*e(c + lead)
//     learned(c) = sum of w(k)*v(c + k), k from -half_width to half_width
typedef struct bowden_learning_settings_f32 {
    // Of the error, not zero, of the sign of the plant's [command unit/output unit].
    float gain;
    // Greatest magnitude of what is learned, above zero [command unit].
    float limit;
    // Share of what a cell has learned that is forgotten each time, from 0 to 1.
    float forgetting;
    // How many cells a command comes before its effect.
    uint16_t lead;
    // Half width of the triangle [cells]; 0 filters nothing.
    uint16_t half_width;
} bowden_learning_settings_f32;

// What a step of a learning gives.
typedef struct bowden_learning_output_f32 {
    // To be added to the command, as feed_forward of a controller [command unit];
    // finite and within the limit in any case.
    float feed_forward;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
} bowden_learning_output_f32;

// A learning with its state but for two arrays of the caller; made by
// bowden_learning_init or bowden_learning_resume.
typedef struct bowden_learning_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_LEARNING_F64_WORDS];
} bowden_learning_f64;

// Settings of a learning. A cycle is divided into cells of equal phase; with e the mean
// of reference - measured over a cell, and w(k) a triangle of area 1:
//
//     v(c) = (1 - forgetting)*learned(c) + gain*e(c + lead)
//     learned(c) = sum of w(k)*v(c + k), k from -half_width to half_width
typedef struct bowden_learning_settings_f64 {
    // Of the error, not zero, of the sign of the plant's [command unit/output unit].
    double gain;
    // Greatest magnitude of what is learned, above zero [command unit].
    double limit;
    // Share of what a cell has learned that is forgotten each time, from 0 to 1.
    double forgetting;
    // How many cells a command comes before its effect.
    uint16_t lead;
    // Half width of the triangle [cells]; 0 filters nothing.
    uint16_t half_width;
} bowden_learning_settings_f64;

// What a step of a learning gives.
typedef struct bowden_learning_output_f64 {
    // To be added to the command, as feed_forward of a controller [command unit];
    // finite and within the limit in any case.
    double feed_forward;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
} bowden_learning_output_f64;

// One sample for a model.
typedef struct bowden_model_sample_f32 {
    // Since the previous sample, above zero, also at the first one [s].
    float dt;
    // The transmission's input, x or tau_i, with its rates.
    struct bowden_motion_f32 input;
    // The transmitted load: tau_i in torque mode, else a load channel.
    float load;
    // All other channels, in the order of the model's file; may be null where
    // there are none.
    const struct bowden_motion_f32 *channels;
    // How many there are, at most BOWDEN_CHANNELS.
    size_t channel_count;
} bowden_model_sample_f32;

// One sample for a model.
typedef struct bowden_model_sample_f64 {
    // Since the previous sample, above zero, also at the first one [s].
    double dt;
    // The transmission's input, x or tau_i, with its rates.
    struct bowden_motion_f64 input;
    // The transmitted load: tau_i in torque mode, else a load channel.
    double load;
    // All other channels, in the order of the model's file; may be null where
    // there are none.
    const struct bowden_motion_f64 *channels;
    // How many there are, at most BOWDEN_CHANNELS.
    size_t channel_count;
} bowden_model_sample_f64;

// An observer with its state; made by bowden_observer_init.
typedef struct bowden_observer_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_OBSERVER_F32_WORDS];
} bowden_observer_f32;

// Settings of a disturbance observer. The nominal plant from command to output is
//
//     P(s) = gain/(s^2/wn^2 + 2*zeta*s/wn + 1)
//
// of a motor with inertia J and damping c that works against a stiffness K:
// wn = sqrt(K/J), zeta = c/(2*sqrt(K*J)). Where they are uncertain, err low with wn and gain.
typedef struct bowden_observer_settings_f32 {
    // Of the nominal plant, not zero [output unit/command unit].
    float gain;
    // wn of the nominal plant, above zero [rad/s].
    float natural_frequency;
    // zeta of the nominal plant, not below zero.
    float damping_ratio;
    // tau of the filter Q = 1/(tau*s + 1)^2, above zero [s].
    float time_constant;
    // Greatest magnitude of the estimate, above zero [command unit].
    float limit;
    // Longest dt that is a sample, above zero [s].
    float longest_dt;
    // How long a command takes to show in the measured output, beside what the nominal
    // plant takes; not below zero [s].
    float latency;
} bowden_observer_settings_f32;

// What a step of an observer gives.
typedef struct bowden_observer_output_f32 {
    // To be added to the command, as feed_forward of a controller [command unit];
    // finite and within the limit in any case.
    float estimate;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
} bowden_observer_output_f32;

// An observer with its state; made by bowden_observer_init.
typedef struct bowden_observer_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_OBSERVER_F64_WORDS];
} bowden_observer_f64;

// Settings of a disturbance observer. The nominal plant from command to output is
//
//     P(s) = gain/(s^2/wn^2 + 2*zeta*s/wn + 1)
//
// of a motor with inertia J and damping c that works against a stiffness K:
// wn = sqrt(K/J), zeta = c/(2*sqrt(K*J)). Where they are uncertain, err low with wn and gain.
typedef struct bowden_observer_settings_f64 {
    // Of the nominal plant, not zero [output unit/command unit].
    double gain;
    // wn of the nominal plant, above zero [rad/s].
    double natural_frequency;
    // zeta of the nominal plant, not below zero.
    double damping_ratio;
    // tau of the filter Q = 1/(tau*s + 1)^2, above zero [s].
    double time_constant;
    // Greatest magnitude of the estimate, above zero [command unit].
    double limit;
    // Longest dt that is a sample, above zero [s].
    double longest_dt;
    // How long a command takes to show in the measured output, beside what the nominal
    // plant takes; not below zero [s].
    double latency;
} bowden_observer_settings_f64;

// What a step of an observer gives.
typedef struct bowden_observer_output_f64 {
    // To be added to the command, as feed_forward of a controller [command unit];
    // finite and within the limit in any case.
    double estimate;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
} bowden_observer_output_f64;

// Settings of a PI (15), PID (14) or PIV (16):
//
//     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*d/dt(y - c*y_r) + u_ff
//     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*v_d             + u_ff    (PIV)
//     command = u within the range and the slew rate;  e = y - y_r
typedef struct bowden_pid_settings_f32 {
    // Proportional gain [command unit/output unit].
    float k_p;
    // Integral gain [command unit/(output unit*s)], of the sign of k_p.
    float k_i;
    // Derivative gain [command unit*s/output unit], of the sign of k_p; for PIV
    // [command unit*s/rad]. 0 for a PI.
    float k_d;
    // One of bowden_damping: what k_d multiplies.
    uint32_t damping;
    // Set-point weight c of the derivative, 0 to 1.
    float derivative_weight;
    // Time constant of the derivative's filter, from 0 (none) up [s].
    float derivative_time;
    // Set-point weight b of the proportional term, 0 to 1.
    float setpoint_weight;
    // One of bowden_anti_windup.
    uint32_t anti_windup;
    // Of BOWDEN_ANTI_WINDUP_BACK_CALCULATION alone, above zero [s].
    float tracking_time;
    // Range and slew rate of the command.
    struct bowden_limits_f32 limits;
    // Longest dt that is a sample, above zero [s]: five nominal steps, say.
    float longest_dt;
    // What goes out when samples stay bad.
    struct bowden_fallback_f32 fallback;
} bowden_pid_settings_f32;

// A PI, PID or PIV with its state; the caller's memory, made by bowden_pid_init.
// It may be copied and moved as a whole.
typedef struct bowden_pid_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_PID_F32_WORDS];
} bowden_pid_f32;

// One sample for a PI, PID or PIV.
typedef struct bowden_pid_sample_f32 {
    // Since the last call, also where that was a bad sample [s].
    float dt;
    // y_r [output unit], such as [N*m].
    float reference;
    // y [output unit], such as [N*m].
    float measured;
    // Measured distal velocity [rad/s]; only PIV (16) reads it.
    float velocity;
    // Added to the command before the limits [command unit]; 0 for none.
    float feed_forward;
} bowden_pid_sample_f32;

// Every term of the last good sample; they add up to `unlimited`.
typedef struct bowden_pid_terms_f32 {
    // e = y - y_r [output unit].
    float error;
    // -k_p*(y - b*y_r) [command unit].
    float proportional;
    // -k_i*integral(e), with what the anti-windup did to it [command unit].
    float integral;
    // -k_d*d/dt(y - c*y_r), filtered [command unit]; zero with PIV.
    float derivative;
    // -k_d*v_d of PIV [command unit]; zero with PI and PID.
    float velocity;
    // As it was given [command unit].
    float feed_forward;
    // The sum before range and slew rate [command unit].
    float unlimited;
    // 1 where range or slew rate changed the command, else 0.
    uint32_t saturated;
} bowden_pid_terms_f32;

// Settings of a PI (15), PID (14) or PIV (16):
//
//     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*d/dt(y - c*y_r) + u_ff
//     u = -k_p*(y - b*y_r) - k_i*integral(e) - k_d*v_d             + u_ff    (PIV)
//     command = u within the range and the slew rate;  e = y - y_r
typedef struct bowden_pid_settings_f64 {
    // Proportional gain [command unit/output unit].
    double k_p;
    // Integral gain [command unit/(output unit*s)], of the sign of k_p.
    double k_i;
    // Derivative gain [command unit*s/output unit], of the sign of k_p; for PIV
    // [command unit*s/rad]. 0 for a PI.
    double k_d;
    // One of bowden_damping: what k_d multiplies.
    uint32_t damping;
    // Set-point weight c of the derivative, 0 to 1.
    double derivative_weight;
    // Time constant of the derivative's filter, from 0 (none) up [s].
    double derivative_time;
    // Set-point weight b of the proportional term, 0 to 1.
    double setpoint_weight;
    // One of bowden_anti_windup.
    uint32_t anti_windup;
    // Of BOWDEN_ANTI_WINDUP_BACK_CALCULATION alone, above zero [s].
    double tracking_time;
    // Range and slew rate of the command.
    struct bowden_limits_f64 limits;
    // Longest dt that is a sample, above zero [s]: five nominal steps, say.
    double longest_dt;
    // What goes out when samples stay bad.
    struct bowden_fallback_f64 fallback;
} bowden_pid_settings_f64;

// A PI, PID or PIV with its state; the caller's memory, made by bowden_pid_init.
// It may be copied and moved as a whole.
typedef struct bowden_pid_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_PID_F64_WORDS];
} bowden_pid_f64;

// One sample for a PI, PID or PIV.
typedef struct bowden_pid_sample_f64 {
    // Since the last call, also where that was a bad sample [s].
    double dt;
    // y_r [output unit], such as [N*m].
    double reference;
    // y [output unit], such as [N*m].
    double measured;
    // Measured distal velocity [rad/s]; only PIV (16) reads it.
    double velocity;
    // Added to the command before the limits [command unit]; 0 for none.
    double feed_forward;
} bowden_pid_sample_f64;

// Every term of the last good sample; they add up to `unlimited`.
typedef struct bowden_pid_terms_f64 {
    // e = y - y_r [output unit].
    double error;
    // -k_p*(y - b*y_r) [command unit].
    double proportional;
    // -k_i*integral(e), with what the anti-windup did to it [command unit].
    double integral;
    // -k_d*d/dt(y - c*y_r), filtered [command unit]; zero with PIV.
    double derivative;
    // -k_d*v_d of PIV [command unit]; zero with PI and PID.
    double velocity;
    // As it was given [command unit].
    double feed_forward;
    // The sum before range and slew rate [command unit].
    double unlimited;
    // 1 where range or slew rate changed the command, else 0.
    uint32_t saturated;
} bowden_pid_terms_f64;

// A play with its state; made by bowden_play_init.
typedef struct bowden_play_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_PLAY_F32_WORDS];
} bowden_play_f32;

// A play with its state; made by bowden_play_init.
typedef struct bowden_play_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_PLAY_F64_WORDS];
} bowden_play_f64;

// Rates with their state; made by bowden_rates_init.
typedef struct bowden_rates_f32 {
    // Not for use.
    uint64_t opaque[BOWDEN_RATES_F32_WORDS];
} bowden_rates_f32;

// What a step of the rates gives.
typedef struct bowden_rates_output_f32 {
    // Position (unwrapped), velocity and acceleration; finite, zero before the
    // first good sample.
    struct bowden_motion_f32 motion;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
} bowden_rates_output_f32;

// Rates with their state; made by bowden_rates_init.
typedef struct bowden_rates_f64 {
    // Not for use.
    uint64_t opaque[BOWDEN_RATES_F64_WORDS];
} bowden_rates_f64;

// What a step of the rates gives.
typedef struct bowden_rates_output_f64 {
    // Position (unwrapped), velocity and acceleration; finite, zero before the
    // first good sample.
    struct bowden_motion_f64 motion;
    // What the step did: the same as it returns.
    bowden_result result;
    // What was wrong.
    bowden_fault fault;
} bowden_rates_output_f64;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Settings to start from: no regressors, beta_hat fixed at 1, delta_hat and
// theta_hat at 0, tanh, no limit of z, no slew rate, 4 good samples for a bad one.
//
// The form is the literal one with 5 ms, and `step` is `longest_dt`. `low` and
// `high` [command unit] are what the drive may get, `safe` [command unit] goes out
// from the `after`-th bad sample in a row on. k, lambda [1/s] and epsilon [N*m] are
// the paper's 24, 8 and 0.05. Numbers are checked by bowden_adaptive_init.
bowden_result bowden_adaptive_settings_start_f32(struct bowden_adaptive_settings_f32 *settings,
                                                 float low,
                                                 float high,
                                                 float longest_dt,
                                                 uint32_t after,
                                                 float safe);

// Checks the settings and starts with the initial estimates.
//
// `about` may be null; else it gets the name of what is refused. On an error the
// object is as it was.
bowden_result bowden_adaptive_init_f32(struct bowden_adaptive_f32 *law,
                                       const struct bowden_adaptive_settings_f32 *settings,
                                       struct bowden_about *about);

// One sample: the command, and what happened; as bowden_pid_step.
bowden_result bowden_adaptive_step_f32(struct bowden_adaptive_f32 *law,
                                       const struct bowden_adaptive_sample_f32 *sample,
                                       struct bowden_output_f32 *out);

// What the law has estimated so far.
bowden_result bowden_adaptive_get_estimates_f32(const struct bowden_adaptive_f32 *law,
                                                struct bowden_estimates_f32 *out);

// Takes note that somebody has seen the fault, as bowden_pid_acknowledge.
bowden_result bowden_adaptive_acknowledge_f32(struct bowden_adaptive_f32 *law);

// Forgets the accumulated error and what was estimated; the command that is out
// stays known, and a safe command that is latched stays so.
bowden_result bowden_adaptive_reset_f32(struct bowden_adaptive_f32 *law);

// Makes an object that was stored fit for a start, as bowden_pid_power_up; what was
// estimated stays.
bowden_result bowden_adaptive_power_up_f32(struct bowden_adaptive_f32 *law);

// Other settings for a loop that runs, without a jump of the command on this sample, as
// bowden_pid_change. What was estimated stays, each in its new box, and so does a safe
// command that is latched.
bowden_result bowden_adaptive_change_f32(struct bowden_adaptive_f32 *law,
                                         const struct bowden_adaptive_settings_f32 *settings,
                                         const struct bowden_adaptive_sample_f32 *sample,
                                         struct bowden_about *about);

// Starts with the initial estimates, so that the next step on this sample commands
// `command` [command unit], as bowden_pid_resume.
bowden_result bowden_adaptive_resume_f32(struct bowden_adaptive_f32 *law,
                                         float command,
                                         const struct bowden_adaptive_sample_f32 *sample,
                                         struct bowden_output_f32 *out);

// 1 into `latched` while the safe command is out until it is acknowledged, else 0.
bowden_result bowden_adaptive_is_latched_f32(const struct bowden_adaptive_f32 *law,
                                             uint32_t *latched);

// Settings to start from: no regressors, beta_hat fixed at 1, delta_hat and
// theta_hat at 0, tanh, no limit of z, no slew rate, 4 good samples for a bad one.
//
// The form is the literal one with 5 ms, and `step` is `longest_dt`. `low` and
// `high` [command unit] are what the drive may get, `safe` [command unit] goes out
// from the `after`-th bad sample in a row on. k, lambda [1/s] and epsilon [N*m] are
// the paper's 24, 8 and 0.05. Numbers are checked by bowden_adaptive_init.
bowden_result bowden_adaptive_settings_start_f64(struct bowden_adaptive_settings_f64 *settings,
                                                 double low,
                                                 double high,
                                                 double longest_dt,
                                                 uint32_t after,
                                                 double safe);

// Checks the settings and starts with the initial estimates.
//
// `about` may be null; else it gets the name of what is refused. On an error the
// object is as it was.
bowden_result bowden_adaptive_init_f64(struct bowden_adaptive_f64 *law,
                                       const struct bowden_adaptive_settings_f64 *settings,
                                       struct bowden_about *about);

// One sample: the command, and what happened; as bowden_pid_step.
bowden_result bowden_adaptive_step_f64(struct bowden_adaptive_f64 *law,
                                       const struct bowden_adaptive_sample_f64 *sample,
                                       struct bowden_output_f64 *out);

// What the law has estimated so far.
bowden_result bowden_adaptive_get_estimates_f64(const struct bowden_adaptive_f64 *law,
                                                struct bowden_estimates_f64 *out);

// Takes note that somebody has seen the fault, as bowden_pid_acknowledge.
bowden_result bowden_adaptive_acknowledge_f64(struct bowden_adaptive_f64 *law);

// Forgets the accumulated error and what was estimated; the command that is out
// stays known, and a safe command that is latched stays so.
bowden_result bowden_adaptive_reset_f64(struct bowden_adaptive_f64 *law);

// Makes an object that was stored fit for a start, as bowden_pid_power_up; what was
// estimated stays.
bowden_result bowden_adaptive_power_up_f64(struct bowden_adaptive_f64 *law);

// Other settings for a loop that runs, without a jump of the command on this sample, as
// bowden_pid_change. What was estimated stays, each in its new box, and so does a safe
// command that is latched.
bowden_result bowden_adaptive_change_f64(struct bowden_adaptive_f64 *law,
                                         const struct bowden_adaptive_settings_f64 *settings,
                                         const struct bowden_adaptive_sample_f64 *sample,
                                         struct bowden_about *about);

// Starts with the initial estimates, so that the next step on this sample commands
// `command` [command unit], as bowden_pid_resume.
bowden_result bowden_adaptive_resume_f64(struct bowden_adaptive_f64 *law,
                                         double command,
                                         const struct bowden_adaptive_sample_f64 *sample,
                                         struct bowden_output_f64 *out);

// 1 into `latched` while the safe command is out until it is acknowledged, else 0.
bowden_result bowden_adaptive_is_latched_f64(const struct bowden_adaptive_f64 *law,
                                             uint32_t *latched);

// Turns a loaded model round, (5)-(7), and starts at zero:
//
//     tau_i = inverse transmission(desired - sum of gain*regressor, eta)
//
// `longest_dt` [s]: a longer dt is a bad sample. `ranges`: motions are clamped to
// them, each read by a term of the model; null where `range_count` is 0.
// BOWDEN_RESULT_ERROR_INADMISSIBLE where the model has no inverse. The model is not
// needed afterwards. On an error the object is as it was. `about` may be null.
bowden_result bowden_compensator_init_f32(struct bowden_compensator_f32 *compensator,
                                          const struct bowden_model_f32 *model,
                                          float longest_dt,
                                          const struct bowden_range_f32 *ranges,
                                          size_t range_count,
                                          struct bowden_about *about);

// Lets what the cable has to transmit pass through a play of this half-width, zero or
// more [output unit]; zero, as init has it, is none.
//
// A term that reads a velocity from an encoder's counts makes a reversal of each count,
// after which the inverse is steep, and the command chatters. A little more than half of
// what one count makes of torque takes that out: |gain|*count/(2*time constant). On an
// error the object is as it was.
bowden_result bowden_compensator_set_play_f32(struct bowden_compensator_f32 *compensator,
                                              float half_width,
                                              struct bowden_about *about);

// One sample: the input that makes the model's output `desired`.
//
// A bad sample leaves the state and holds the last good command, zero before the
// first one: BOWDEN_RESULT_HELD. `out` is written with every result that is not
// negative.
bowden_result bowden_compensator_step_f32(struct bowden_compensator_f32 *compensator,
                                          const struct bowden_compensator_sample_f32 *sample,
                                          struct bowden_compensator_output_f32 *out);

// The state of the start again, with this hysteresis state, within -1 and 1.
bowden_result bowden_compensator_reset_f32(struct bowden_compensator_f32 *compensator, float eta);

// Turns a loaded model round, (5)-(7), and starts at zero:
//
//     tau_i = inverse transmission(desired - sum of gain*regressor, eta)
//
// `longest_dt` [s]: a longer dt is a bad sample. `ranges`: motions are clamped to
// them, each read by a term of the model; null where `range_count` is 0.
// BOWDEN_RESULT_ERROR_INADMISSIBLE where the model has no inverse. The model is not
// needed afterwards. On an error the object is as it was. `about` may be null.
bowden_result bowden_compensator_init_f64(struct bowden_compensator_f64 *compensator,
                                          const struct bowden_model_f64 *model,
                                          double longest_dt,
                                          const struct bowden_range_f64 *ranges,
                                          size_t range_count,
                                          struct bowden_about *about);

// Lets what the cable has to transmit pass through a play of this half-width, zero or
// more [output unit]; zero, as init has it, is none.
//
// A term that reads a velocity from an encoder's counts makes a reversal of each count,
// after which the inverse is steep, and the command chatters. A little more than half of
// what one count makes of torque takes that out: |gain|*count/(2*time constant). On an
// error the object is as it was.
bowden_result bowden_compensator_set_play_f64(struct bowden_compensator_f64 *compensator,
                                              double half_width,
                                              struct bowden_about *about);

// One sample: the input that makes the model's output `desired`.
//
// A bad sample leaves the state and holds the last good command, zero before the
// first one: BOWDEN_RESULT_HELD. `out` is written with every result that is not
// negative.
bowden_result bowden_compensator_step_f64(struct bowden_compensator_f64 *compensator,
                                          const struct bowden_compensator_sample_f64 *sample,
                                          struct bowden_compensator_output_f64 *out);

// The state of the start again, with this hysteresis state, within -1 and 1.
bowden_result bowden_compensator_reset_f64(struct bowden_compensator_f64 *compensator, double eta);

// Starts a hysteresis at `eta`, within -1 and 1: rho above zero [1/input unit],
// sigma at least 1/2, n at least 1. `about` may be null.
bowden_result bowden_hysteresis_init_f32(struct bowden_hysteresis_f32 *hysteresis,
                                         float rho,
                                         float sigma,
                                         float n,
                                         float eta,
                                         struct bowden_about *about);

// One input [input unit]: `eta` gets the state, within -1 and 1. The first sample
// only sets the input. One that is not finite is held: BOWDEN_RESULT_HELD.
bowden_result bowden_hysteresis_step_f32(struct bowden_hysteresis_f32 *hysteresis,
                                         float input,
                                         float *eta);

// Checks the figures and starts a transmission. `about` may be null.
bowden_result bowden_cable_init_f32(struct bowden_cable_f32 *cable,
                                    const struct bowden_cable_settings_f32 *settings,
                                    struct bowden_about *about);

// One input [input unit]: `output` gets the output [output unit]. One that is not
// finite is held: BOWDEN_RESULT_HELD, and the last output, zero before the first.
bowden_result bowden_cable_step_f32(struct bowden_cable_f32 *cable, float input, float *output);

// The same figures turned round; BOWDEN_RESULT_ERROR_INADMISSIBLE where the
// transmission has no inverse (sigma above gain/(2*kappa_eta*rho)).
bowden_result bowden_inverse_init_f32(struct bowden_inverse_f32 *inverse,
                                      const struct bowden_cable_settings_f32 *settings,
                                      struct bowden_about *about);

// One output that is wanted [output unit]: `input` gets the input [input unit] that
// gives it. One that is not finite is held: BOWDEN_RESULT_HELD.
bowden_result bowden_inverse_step_f32(struct bowden_inverse_f32 *inverse,
                                      float desired,
                                      float *input);

// Starts a hysteresis at `eta`, within -1 and 1: rho above zero [1/input unit],
// sigma at least 1/2, n at least 1. `about` may be null.
bowden_result bowden_hysteresis_init_f64(struct bowden_hysteresis_f64 *hysteresis,
                                         double rho,
                                         double sigma,
                                         double n,
                                         double eta,
                                         struct bowden_about *about);

// One input [input unit]: `eta` gets the state, within -1 and 1. The first sample
// only sets the input. One that is not finite is held: BOWDEN_RESULT_HELD.
bowden_result bowden_hysteresis_step_f64(struct bowden_hysteresis_f64 *hysteresis,
                                         double input,
                                         double *eta);

// Checks the figures and starts a transmission. `about` may be null.
bowden_result bowden_cable_init_f64(struct bowden_cable_f64 *cable,
                                    const struct bowden_cable_settings_f64 *settings,
                                    struct bowden_about *about);

// One input [input unit]: `output` gets the output [output unit]. One that is not
// finite is held: BOWDEN_RESULT_HELD, and the last output, zero before the first.
bowden_result bowden_cable_step_f64(struct bowden_cable_f64 *cable, double input, double *output);

// The same figures turned round; BOWDEN_RESULT_ERROR_INADMISSIBLE where the
// transmission has no inverse (sigma above gain/(2*kappa_eta*rho)).
bowden_result bowden_inverse_init_f64(struct bowden_inverse_f64 *inverse,
                                      const struct bowden_cable_settings_f64 *settings,
                                      struct bowden_about *about);

// One output that is wanted [output unit]: `input` gets the input [input unit] that
// gives it. One that is not finite is held: BOWDEN_RESULT_HELD.
bowden_result bowden_inverse_step_f64(struct bowden_inverse_f64 *inverse,
                                      double desired,
                                      double *input);

// Starts a learning that has learned nothing, over two arrays of `cells` numbers, which
// it sets to zero: at least lead + 2*half_width + 9, at most BOWDEN_CELLS.
//
// The arrays stay the caller's. They must be there, and nobody may write to them, for
// as long as the object is used: a local array of the function that calls this is
// wrong where the object outlives it. Between two calls `learned` may be read, for a
// plot or to be stored. They overlap neither each other nor the object
// (BOWDEN_RESULT_ERROR_INADMISSIBLE), and serve one object at a time; a copy of the
// object goes on with the same arrays, so only one of the two may be used.
//
// On an error object and arrays are as they were. `about` may be null.
bowden_result bowden_learning_init_f32(struct bowden_learning_f32 *learning,
                                       const struct bowden_learning_settings_f32 *settings,
                                       float *learned,
                                       float *unfiltered,
                                       size_t cells,
                                       struct bowden_about *about);

// The same where `learned` holds what was learned before, such as a copy from before a
// reset, or an array that another object has learned in and is used with no more; it is
// confined to the limit, and zero for NaN. `unfiltered` may hold anything.
bowden_result bowden_learning_resume_f32(struct bowden_learning_f32 *learning,
                                         const struct bowden_learning_settings_f32 *settings,
                                         float *learned,
                                         float *unfiltered,
                                         size_t cells,
                                         struct bowden_about *about);

// One sample, before the controller's own: where in the cycle it is, from 0 to 1, the
// reference and the measured output [output unit]. `learns` is 0 where what is out is not
// to be learned from: where a limit cut the command, the safe one is out, or the task is
// another one. Where that is so of more than half of a cell's samples, the errors of the
// next `lead` cells teach nothing either.
//
// A phase that is not from 0 to 1 moves nothing and holds the feed-forward:
// BOWDEN_RESULT_HELD, for as long as there is none; the controller's samples are good
// meanwhile. BOWDEN_RESULT_DEGRADED where the feed-forward is of this phase but
// reference or measured output are not finite, so that nothing was learned, or where the
// phase has jumped, by more than four cells: the cell that was left does not learn then,
// and the feed-forward jumps with the phase. Give the controller a slew rate. `out` is
// written with every result that is not negative.
bowden_result bowden_learning_step_f32(struct bowden_learning_f32 *learning,
                                       float phase,
                                       float reference,
                                       float measured,
                                       uint32_t learns,
                                       struct bowden_learning_output_f32 *out);

// Starts a learning that has learned nothing, over two arrays of `cells` numbers, which
// it sets to zero: at least lead + 2*half_width + 9, at most BOWDEN_CELLS.
//
// The arrays stay the caller's. They must be there, and nobody may write to them, for
// as long as the object is used: a local array of the function that calls this is
// wrong where the object outlives it. Between two calls `learned` may be read, for a
// plot or to be stored. They overlap neither each other nor the object
// (BOWDEN_RESULT_ERROR_INADMISSIBLE), and serve one object at a time; a copy of the
// object goes on with the same arrays, so only one of the two may be used.
//
// On an error object and arrays are as they were. `about` may be null.
bowden_result bowden_learning_init_f64(struct bowden_learning_f64 *learning,
                                       const struct bowden_learning_settings_f64 *settings,
                                       double *learned,
                                       double *unfiltered,
                                       size_t cells,
                                       struct bowden_about *about);

// The same where `learned` holds what was learned before, such as a copy from before a
// reset, or an array that another object has learned in and is used with no more; it is
// confined to the limit, and zero for NaN. `unfiltered` may hold anything.
bowden_result bowden_learning_resume_f64(struct bowden_learning_f64 *learning,
                                         const struct bowden_learning_settings_f64 *settings,
                                         double *learned,
                                         double *unfiltered,
                                         size_t cells,
                                         struct bowden_about *about);

// One sample, before the controller's own: where in the cycle it is, from 0 to 1, the
// reference and the measured output [output unit]. `learns` is 0 where what is out is not
// to be learned from: where a limit cut the command, the safe one is out, or the task is
// another one. Where that is so of more than half of a cell's samples, the errors of the
// next `lead` cells teach nothing either.
//
// A phase that is not from 0 to 1 moves nothing and holds the feed-forward:
// BOWDEN_RESULT_HELD, for as long as there is none; the controller's samples are good
// meanwhile. BOWDEN_RESULT_DEGRADED where the feed-forward is of this phase but
// reference or measured output are not finite, so that nothing was learned, or where the
// phase has jumped, by more than four cells: the cell that was left does not learn then,
// and the feed-forward jumps with the phase. Give the controller a slew rate. `out` is
// written with every result that is not negative.
bowden_result bowden_learning_step_f64(struct bowden_learning_f64 *learning,
                                       double phase,
                                       double reference,
                                       double measured,
                                       uint32_t learns,
                                       struct bowden_learning_output_f64 *out);

// Loads a model from the bytes that `bowden close --model-out FILE.postcard` or
// `bowden export --c` writes, four bytes of CRC-32 last, and starts it.
//
// `length` is that of the model, not of an array or a sector that is larger: bytes
// behind the CRC-32 are refused as damaged ones are. `eta` is the hysteresis state
// at the start, within -1 and 1; 0 where it is not known.
// BOWDEN_RESULT_ERROR_MODEL where the bytes are damaged, too many, of the other
// precision, of another version, or hold more than BOWDEN_TERMS terms; `about`,
// which may be null, tells the first two ("checksum") from the others.
// BOWDEN_RESULT_ERROR_CAPACITY where a term reads a channel from BOWDEN_CHANNELS
// on, or there are more than BOWDEN_MODEL_BYTES bytes. The bytes are not needed
// afterwards. On an error the object is as it was.
bowden_result bowden_model_load_f32(struct bowden_model_f32 *model,
                                    const uint8_t *bytes,
                                    size_t length,
                                    float eta,
                                    struct bowden_about *about);

// One sample: `output` gets the predicted output [output unit]:
//
//     y = transmission(input, eta) + sum of gain*regressor
//
// A bad sample (a dt that is not positive, a number that the model reads that is
// not finite, a channel that is missing) leaves the state and gives the last good
// output, 0 before the first one: BOWDEN_RESULT_HELD.
bowden_result bowden_model_step_f32(struct bowden_model_f32 *model,
                                    const struct bowden_model_sample_f32 *sample,
                                    float *output);

// The hysteresis state, within -1 and 1.
bowden_result bowden_model_eta_f32(const struct bowden_model_f32 *model, float *eta);

// The state of the start again, with this hysteresis state.
bowden_result bowden_model_reset_f32(struct bowden_model_f32 *model, float eta);

// Loads a model from the bytes that `bowden close --model-out FILE.postcard` or
// `bowden export --c` writes, four bytes of CRC-32 last, and starts it.
//
// `length` is that of the model, not of an array or a sector that is larger: bytes
// behind the CRC-32 are refused as damaged ones are. `eta` is the hysteresis state
// at the start, within -1 and 1; 0 where it is not known.
// BOWDEN_RESULT_ERROR_MODEL where the bytes are damaged, too many, of the other
// precision, of another version, or hold more than BOWDEN_TERMS terms; `about`,
// which may be null, tells the first two ("checksum") from the others.
// BOWDEN_RESULT_ERROR_CAPACITY where a term reads a channel from BOWDEN_CHANNELS
// on, or there are more than BOWDEN_MODEL_BYTES bytes. The bytes are not needed
// afterwards. On an error the object is as it was.
bowden_result bowden_model_load_f64(struct bowden_model_f64 *model,
                                    const uint8_t *bytes,
                                    size_t length,
                                    double eta,
                                    struct bowden_about *about);

// One sample: `output` gets the predicted output [output unit]:
//
//     y = transmission(input, eta) + sum of gain*regressor
//
// A bad sample (a dt that is not positive, a number that the model reads that is
// not finite, a channel that is missing) leaves the state and gives the last good
// output, 0 before the first one: BOWDEN_RESULT_HELD.
bowden_result bowden_model_step_f64(struct bowden_model_f64 *model,
                                    const struct bowden_model_sample_f64 *sample,
                                    double *output);

// The hysteresis state, within -1 and 1.
bowden_result bowden_model_eta_f64(const struct bowden_model_f64 *model, double *eta);

// The state of the start again, with this hysteresis state.
bowden_result bowden_model_reset_f64(struct bowden_model_f64 *model, double eta);

// Starts an observer. `about` may be null.
bowden_result bowden_observer_init_f32(struct bowden_observer_f32 *observer,
                                       const struct bowden_observer_settings_f32 *settings,
                                       struct bowden_about *about);

// One sample, before the controller's own: `dt` since the last call [s], the command
// that went out at the last call behind all limits [command unit], the measured
// output [output unit].
//
// A bad sample holds the estimate: BOWDEN_RESULT_HELD. `out` is written with every
// result that is not negative.
bowden_result bowden_observer_step_f32(struct bowden_observer_f32 *observer,
                                       float dt,
                                       float sent,
                                       float measured,
                                       struct bowden_observer_output_f32 *out);

// The command that makes the nominal plant follow, [command unit]: of the output that
// is wanted with its rates, taken as far ahead as the latency.
bowden_result bowden_observer_feed_forward_f32(const struct bowden_observer_f32 *observer,
                                               const struct bowden_motion_f32 *wanted,
                                               float *command);

// The state of the start again: where the drive was off, for a command that did not
// reach the motor is no command.
bowden_result bowden_observer_reset_f32(struct bowden_observer_f32 *observer);

// Starts an observer. `about` may be null.
bowden_result bowden_observer_init_f64(struct bowden_observer_f64 *observer,
                                       const struct bowden_observer_settings_f64 *settings,
                                       struct bowden_about *about);

// One sample, before the controller's own: `dt` since the last call [s], the command
// that went out at the last call behind all limits [command unit], the measured
// output [output unit].
//
// A bad sample holds the estimate: BOWDEN_RESULT_HELD. `out` is written with every
// result that is not negative.
bowden_result bowden_observer_step_f64(struct bowden_observer_f64 *observer,
                                       double dt,
                                       double sent,
                                       double measured,
                                       struct bowden_observer_output_f64 *out);

// The command that makes the nominal plant follow, [command unit]: of the output that
// is wanted with its rates, taken as far ahead as the latency.
bowden_result bowden_observer_feed_forward_f64(const struct bowden_observer_f64 *observer,
                                               const struct bowden_motion_f64 *wanted,
                                               double *command);

// The state of the start again: where the drive was off, for a command that did not
// reach the motor is no command.
bowden_result bowden_observer_reset_f64(struct bowden_observer_f64 *observer);

// Settings of a plain PI (15): full set-point weight, conditional anti-windup, no
// slew rate, 4 good samples for a bad one.
//
// `low` and `high` [command unit] are what the drive may get, `longest_dt` [s] the
// longest sample time, `safe` [command unit] what goes out from the `after`-th bad
// sample in a row on. Numbers are checked by bowden_pid_init.
bowden_result bowden_pid_settings_pi_f32(struct bowden_pid_settings_f32 *settings,
                                         float k_p,
                                         float k_i,
                                         float low,
                                         float high,
                                         float longest_dt,
                                         uint32_t after,
                                         float safe);

// Checks the settings and starts with a state that has seen no sample.
//
// `about` may be null; else it gets the name of what is refused. On an error the
// object is as it was.
bowden_result bowden_pid_init_f32(struct bowden_pid_f32 *pid,
                                  const struct bowden_pid_settings_f32 *settings,
                                  struct bowden_about *about);

// One sample: the command, and what happened.
//
// A bad sample (NaN, an infinity, a dt that is not positive or too long) leaves the
// state as it was and holds the last good command: BOWDEN_RESULT_HELD. After too
// many the safe command is out, good samples or not, until bowden_pid_acknowledge:
// BOWDEN_RESULT_SAFE. `out` is written with every result that is not negative.
bowden_result bowden_pid_step_f32(struct bowden_pid_f32 *pid,
                                  const struct bowden_pid_sample_f32 *sample,
                                  struct bowden_output_f32 *out);

// Every term of the last good sample, for telemetry; all zero before the first one.
bowden_result bowden_pid_get_terms_f32(const struct bowden_pid_f32 *pid,
                                       struct bowden_pid_terms_f32 *out);

// Takes note that somebody has seen the fault: the next good sample closes the loop
// again, from the safe command on. Nothing where no safe command is latched.
bowden_result bowden_pid_acknowledge_f32(struct bowden_pid_f32 *pid);

// Forgets integral, rate and samples; the command that is out stays known, and a
// safe command that is latched stays so.
bowden_result bowden_pid_reset_f32(struct bowden_pid_f32 *pid);

// Makes an object that was stored fit for a start, before its first step: the power was
// off, and the command is the one nearest to zero that the limits allow. Integral, rate
// and samples are forgotten; a safe command that was latched stays so. The first good
// sample starts from there, without a jump. A step without this goes on with the command
// of then.
bowden_result bowden_pid_power_up_f32(struct bowden_pid_f32 *pid);

// Starts anew so that the command goes on from `command` [command unit] without a
// jump. A number that is not finite counts as a bad sample; a latched safe command
// stays. `out` has the command that is out then, and may be null.
bowden_result bowden_pid_resume_f32(struct bowden_pid_f32 *pid,
                                    float command,
                                    const struct bowden_pid_sample_f32 *sample,
                                    struct bowden_output_f32 *out);

// Other settings for a loop that runs, without a jump of the command; but where the new
// range excludes what is out, the next command is the nearest in it, past any slew rate:
// narrow a range step by step. On an error the loop goes on with the old ones.
bowden_result bowden_pid_change_f32(struct bowden_pid_f32 *pid,
                                    const struct bowden_pid_settings_f32 *settings,
                                    struct bowden_about *about);

// 1 into `latched` while the safe command is out until it is acknowledged, else 0.
bowden_result bowden_pid_is_latched_f32(const struct bowden_pid_f32 *pid, uint32_t *latched);

// Settings of a plain PI (15): full set-point weight, conditional anti-windup, no
// slew rate, 4 good samples for a bad one.
//
// `low` and `high` [command unit] are what the drive may get, `longest_dt` [s] the
// longest sample time, `safe` [command unit] what goes out from the `after`-th bad
// sample in a row on. Numbers are checked by bowden_pid_init.
bowden_result bowden_pid_settings_pi_f64(struct bowden_pid_settings_f64 *settings,
                                         double k_p,
                                         double k_i,
                                         double low,
                                         double high,
                                         double longest_dt,
                                         uint32_t after,
                                         double safe);

// Checks the settings and starts with a state that has seen no sample.
//
// `about` may be null; else it gets the name of what is refused. On an error the
// object is as it was.
bowden_result bowden_pid_init_f64(struct bowden_pid_f64 *pid,
                                  const struct bowden_pid_settings_f64 *settings,
                                  struct bowden_about *about);

// One sample: the command, and what happened.
//
// A bad sample (NaN, an infinity, a dt that is not positive or too long) leaves the
// state as it was and holds the last good command: BOWDEN_RESULT_HELD. After too
// many the safe command is out, good samples or not, until bowden_pid_acknowledge:
// BOWDEN_RESULT_SAFE. `out` is written with every result that is not negative.
bowden_result bowden_pid_step_f64(struct bowden_pid_f64 *pid,
                                  const struct bowden_pid_sample_f64 *sample,
                                  struct bowden_output_f64 *out);

// Every term of the last good sample, for telemetry; all zero before the first one.
bowden_result bowden_pid_get_terms_f64(const struct bowden_pid_f64 *pid,
                                       struct bowden_pid_terms_f64 *out);

// Takes note that somebody has seen the fault: the next good sample closes the loop
// again, from the safe command on. Nothing where no safe command is latched.
bowden_result bowden_pid_acknowledge_f64(struct bowden_pid_f64 *pid);

// Forgets integral, rate and samples; the command that is out stays known, and a
// safe command that is latched stays so.
bowden_result bowden_pid_reset_f64(struct bowden_pid_f64 *pid);

// Makes an object that was stored fit for a start, before its first step: the power was
// off, and the command is the one nearest to zero that the limits allow. Integral, rate
// and samples are forgotten; a safe command that was latched stays so. The first good
// sample starts from there, without a jump. A step without this goes on with the command
// of then.
bowden_result bowden_pid_power_up_f64(struct bowden_pid_f64 *pid);

// Starts anew so that the command goes on from `command` [command unit] without a
// jump. A number that is not finite counts as a bad sample; a latched safe command
// stays. `out` has the command that is out then, and may be null.
bowden_result bowden_pid_resume_f64(struct bowden_pid_f64 *pid,
                                    double command,
                                    const struct bowden_pid_sample_f64 *sample,
                                    struct bowden_output_f64 *out);

// Other settings for a loop that runs, without a jump of the command; but where the new
// range excludes what is out, the next command is the nearest in it, past any slew rate:
// narrow a range step by step. On an error the loop goes on with the old ones.
bowden_result bowden_pid_change_f64(struct bowden_pid_f64 *pid,
                                    const struct bowden_pid_settings_f64 *settings,
                                    struct bowden_about *about);

// 1 into `latched` while the safe command is out until it is acknowledged, else 0.
bowden_result bowden_pid_is_latched_f64(const struct bowden_pid_f64 *pid, uint32_t *latched);

// Starts a play of `half_width` at least zero [input unit], see bowden_play_step; at
// zero the output is the input. `about` may be null.
bowden_result bowden_play_init_f32(struct bowden_play_f32 *play,
                                   float half_width,
                                   struct bowden_about *about);

// One input [input unit]: `output` gets the last output, moved as little as keeps
// it within the half-width r of the input:
//
//     y+ = clamp(y, x - r, x + r)
//
// A wobble of the input within 2*r moves nothing: in front of a model with a
// hysteresis it keeps the sensor's noise from being taken for reversals. The first
// good sample is taken over as it is. One that is not finite is held:
// BOWDEN_RESULT_HELD, and the last output, zero before the first.
bowden_result bowden_play_step_f32(struct bowden_play_f32 *play, float input, float *output);

// Starts a play of `half_width` at least zero [input unit], see bowden_play_step; at
// zero the output is the input. `about` may be null.
bowden_result bowden_play_init_f64(struct bowden_play_f64 *play,
                                   double half_width,
                                   struct bowden_about *about);

// One input [input unit]: `output` gets the last output, moved as little as keeps
// it within the half-width r of the input:
//
//     y+ = clamp(y, x - r, x + r)
//
// A wobble of the input within 2*r moves nothing: in front of a model with a
// hysteresis it keeps the sensor's noise from being taken for reversals. The first
// good sample is taken over as it is. One that is not finite is held:
// BOWDEN_RESULT_HELD, and the last output, zero before the first.
bowden_result bowden_play_step_f64(struct bowden_play_f64 *play, double input, double *output);

// Starts rates: two lags of `time_constant` above zero [s], see
// bowden_rates_step.
//
// `period` [channel unit] where the position wraps around, as a counter does; 0
// where it does not. `longest_gap` [s] is the longest time between two good samples
// that is bridged; 0 for ten time constants. `about` may be null.
bowden_result bowden_rates_init_f32(struct bowden_rates_f32 *rates,
                                    float time_constant,
                                    float period,
                                    float longest_gap,
                                    struct bowden_about *about);

// The motion at a position [channel unit] that came `dt` [s] after the last call,
// good or bad:
//
//     s  = 1 - exp(-h/tau),  h = time since the last good sample
//     v+ = v + s*((x - x_last)/h - v)
//     a+ = a + s*((v+ - v)/h - a)
//
// A bad sample holds the last good motion: BOWDEN_RESULT_HELD. `out` is written with
// every result that is not negative.
bowden_result bowden_rates_step_f32(struct bowden_rates_f32 *rates,
                                    float position,
                                    float dt,
                                    struct bowden_rates_output_f32 *out);

// Starts rates: two lags of `time_constant` above zero [s], see
// bowden_rates_step.
//
// `period` [channel unit] where the position wraps around, as a counter does; 0
// where it does not. `longest_gap` [s] is the longest time between two good samples
// that is bridged; 0 for ten time constants. `about` may be null.
bowden_result bowden_rates_init_f64(struct bowden_rates_f64 *rates,
                                    double time_constant,
                                    double period,
                                    double longest_gap,
                                    struct bowden_about *about);

// The motion at a position [channel unit] that came `dt` [s] after the last call,
// good or bad:
//
//     s  = 1 - exp(-h/tau),  h = time since the last good sample
//     v+ = v + s*((x - x_last)/h - v)
//     a+ = a + s*((v+ - v)/h - a)
//
// A bad sample holds the last good motion: BOWDEN_RESULT_HELD. `out` is written with
// every result that is not negative.
bowden_result bowden_rates_step_f64(struct bowden_rates_f64 *rates,
                                    double position,
                                    double dt,
                                    struct bowden_rates_output_f64 *out);

// A sentence on a result, for a log: ASCII, static, never null; also for a number that is no
// result.
const char *bowden_result_text(int32_t result);

// What was wrong with a sample, for a log: ASCII, static, never null.
const char *bowden_fault_text(int32_t fault);

// The version of the library, such as "0.2.0": static, never null.
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
BOWDEN_ASSERT_SIZE(bowden_learning_f32, BOWDEN_LEARNING_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_learning_f64, BOWDEN_LEARNING_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_play_f32, BOWDEN_PLAY_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_play_f64, BOWDEN_PLAY_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_adaptive_f32, BOWDEN_ADAPTIVE_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_adaptive_f64, BOWDEN_ADAPTIVE_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_model_f32, BOWDEN_MODEL_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_model_f64, BOWDEN_MODEL_F64_WORDS);
BOWDEN_ASSERT_SIZE(bowden_compensator_f32, BOWDEN_COMPENSATOR_F32_WORDS);
BOWDEN_ASSERT_SIZE(bowden_compensator_f64, BOWDEN_COMPENSATOR_F64_WORDS);
#undef BOWDEN_ASSERT_SIZE
#endif /* BOWDEN_SIZES */
