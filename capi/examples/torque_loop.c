/* The torque loop of one joint, to copy into firmware, and a simulated joint for two seconds.
 *
 * A PID closes the loop, the inverse of the identified model is its feed-forward, the adaptive law
 * runs as a second loop, and rates compute a velocity from encoder counts. No heap. In the
 * simulation five samples are lost, a connector is unplugged, and a counter wraps.
 *
 * On a computer, main() prints a line every 100 ms and at each event. On a microcontroller, compiled
 * with -ffreestanding, the board provides `say`, and its start-up code calls main. */
#include "bowden.h"
#include "demo.h" /* bowden export --c demo.toml --out demo.h */

#define DT 0.001f         /* [s] */
#define LONGEST_DT 0.005f /* [s] */
#define COUNTS 16384      /* encoder counts per turn */
#define COUNT (6.2831855f / COUNTS)
#define TICKS 2000

#if defined(__STDC_HOSTED__) && __STDC_HOSTED__
#include <stdio.h>
static void say(const char *line) { puts(line); }
#else
void say(const char *line);
#endif

/* ---- the loop: to be copied ---------------------------------------------------------------- */

typedef struct torque_loop {
    bowden_pid_f32 pid;
    bowden_adaptive_f32 law;
    bowden_model_f32 model;
    bowden_compensator_f32 feed_forward;
    bowden_rates_f32 rates;
} torque_loop;

/* One tick: the readings of the sensors, and the output of the loop. */
typedef struct tick {
    float dt, wanted, torque; /* [s], [N*m], [N*m] */
    uint16_t counts;
    bowden_output_f32 pid, law;         /* commands [N*m] */
    float velocity, predicted, bench;   /* [rad/s], [N*m], [N*m] */
} tick;

/* Checks everything, once. */
static bowden_result start(torque_loop *own, bowden_about *about) {
    bowden_pid_settings_f32 pid = BOWDEN_PID_SETTINGS_F32_INIT;
    bowden_adaptive_settings_f32 law = BOWDEN_ADAPTIVE_SETTINGS_F32_INIT;
    bowden_rates_settings_f32 rates = BOWDEN_RATES_SETTINGS_F32_INIT;
    bowden_result result;

    pid.k_p = 0.5f;          /* [N*m/(N*m)] */
    pid.k_i = 25.0f;         /* [1/s] */
    pid.limits.low = -10.0f; /* [N*m] */
    pid.limits.high = 40.0f;
    pid.longest_dt = LONGEST_DT;
    pid.fallback.after = 20; /* bad samples; then 0 N*m */
    pid.k_d = 0.002f;
    pid.derivative_time = 0.01f;
    pid.anti_windup = BOWDEN_ANTI_WINDUP_BACK_CALCULATION;
    pid.tracking_time = 0.1f;
    pid.limits.slew = 2000.0f;
    result = bowden_pid_init_f32(&own->pid, &pid, about);
    if (result < 0) return result;

    law.limits = pid.limits;
    law.limits.slew = 0.0f;
    law.longest_dt = LONGEST_DT;
    law.fallback = pid.fallback;
    law.form = BOWDEN_FORM_FIRST_ORDER;
    law.step = DT;
    law.plant_gain = 1.0f;
    law.epsilon = 0.1f;
    law.smooth_sign = BOWDEN_SMOOTH_SIGN_CLAMP;
    law.delta.initial = 1.0f;
    law.delta.high = 3.0f;
    law.delta.gain = 0.006f;
    law.delta.leakage = BOWDEN_LEAKAGE_CONSTANT;
    law.delta.leakage_rate = 0.01f;
    law.regressors = 1;
    law.theta[0].low = -3.0f;
    law.theta[0].high = 3.0f;
    law.theta[0].gain = 0.02f;
    law.missing[0] = BOWDEN_ON_MISSING_DROP_REGRESSOR;
    result = bowden_adaptive_init_f32(&own->law, &law, about);
    if (result < 0) return result;

    result = demo_load_f32(&own->model, about);
    if (result < 0) return result;
    result = demo_compensator_f32(&own->feed_forward, &own->model, LONGEST_DT, about);
    if (result < 0) return result;
    rates.time_constant = DEMO_RATES_TIME_CONSTANT_F32;
    rates.period = COUNTS * COUNT;
    return bowden_rates_init_f32(&own->rates, &rates, about);
}

/* One sample, from the timer interrupt. Negative only if an object was not initialised. */
static bowden_result step(torque_loop *own, tick *at) {
    bowden_rates_output_f32 pulley;
    bowden_compensator_sample_f32 wish = {0};
    bowden_compensator_output_f32 bench;
    bowden_model_sample_f32 seen = {0};
    bowden_pid_sample_f32 pid = {0};
    bowden_adaptive_sample_f32 law = {0};
    bowden_motion_f32 channels[DEMO_CHANNELS] = {{0, 0, 0}};
    bowden_result result;

    result = bowden_rates_step_f32(&own->rates, (float)at->counts * COUNT, at->dt, &pulley);
    if (result < 0) return result;
    channels[DEMO_CHANNEL_PHI_P] = pulley.motion;
    at->velocity = pulley.motion.velocity;

    /* From the desired torque, not from the noisy measurement. */
    wish.dt = at->dt;
    wish.desired = at->wanted;
    wish.channels = channels;
    wish.channel_count = DEMO_CHANNELS;
    result = bowden_compensator_step_f32(&own->feed_forward, &wish, &bench);
    if (result < 0) return result;
    at->bench = bench.command;

    pid.dt = at->dt;
    pid.reference = at->wanted;
    pid.measured = at->torque;
    pid.feed_forward = bench.command;
    result = bowden_pid_step_f32(&own->pid, &pid, &at->pid);
    if (result < 0) return result;

    law.dt = at->dt;
    law.reference = law.next_reference = at->wanted;
    law.measured = at->torque;
    law.regressors[0] = pulley.motion.velocity;
    law.feed_forward = bench.command;
    result = bowden_adaptive_step_f32(&own->law, &law, &at->law);
    if (result < 0) return result;

    /* The model's prediction for the applied command: a fault of the cable shows here. */
    seen.dt = at->dt;
    seen.input.position = at->pid.command;
    seen.load = at->pid.command;
    seen.channels = channels;
    seen.channel_count = DEMO_CHANNELS;
    result = bowden_model_step_f32(&own->model, &seen, &at->predicted);
    return result < 0 ? result : at->pid.result;
}

/* ---- a simulated joint for two seconds: not for firmware ----------------------------------- */

static void append(char **to, const char *text) {
    while (*text) *(*to)++ = *text++;
    **to = 0;
}

/* The bits of a number, so that two programs can be compared. */
static void append_bits(char **to, float value) {
    union {
        float value;
        uint32_t bits;
    } own;
    int shift;
    own.value = value;
    for (shift = 28; shift >= 0; shift -= 4)
        *(*to)++ = "0123456789abcdef"[own.bits >> shift & 15];
    **to = 0;
}

static void append_integer(char **to, long value) {
    char digits[12];
    int count = 0;
    if (value < 0) {
        *(*to)++ = '-';
        value = -value;
    }
    do digits[count++] = (char)('0' + value % 10);
    while ((value /= 10) != 0);
    while (count) *(*to)++ = digits[--count];
    **to = 0;
}

/* A triangle between -1 and 1 of this period [ticks]. */
static float triangle(int k, int period) {
    int x = k % period, half = period / 2;
    return 4.0f * (float)(x < half ? x : period - x) / (float)period - 1.0f;
}

static void tell(int k, const tick *at) {
    char line[200], *end = line;
    append_integer(&end, k);
    append(&end, " ms: command ");
    append_integer(&end, (long)(1000.0f * at->pid.command));
    append(&end, " mN*m [");
    append_bits(&end, at->pid.command);
    append(&end, " ");
    append_bits(&end, at->law.command);
    append(&end, " ");
    append_bits(&end, at->velocity);
    append(&end, " ");
    append_bits(&end, at->predicted);
    append(&end, " ");
    append_bits(&end, at->bench);
    append(&end, "] ");
    append(&end, bowden_result_text(at->pid.result));
    if (at->pid.fault != BOWDEN_FAULT_NONE) {
        append(&end, ": ");
        append(&end, bowden_fault_text(at->pid.fault));
    }
    say(line);
}

int main(void) {
    static torque_loop loop;
    bowden_about about;
    bowden_result last = BOWDEN_RESULT_OK, result;
    float drive = 0.0f, torque = 0.0f, nothing = 0.0f;
    int k;

    result = start(&loop, &about);
    if (result < 0) {
        say(bowden_result_text(result));
        say(about.text);
        return 1;
    }
    for (k = 0; k < TICKS; k++) {
        tick at;
        float angle = 0.5f * triangle(k, 800);
        at.dt = k == 1500 ? 4295.0f : DT; /* a counter that wrapped */
        at.wanted = 8.0f + 4.0f * triangle(k, 500);
        at.torque = torque;
        /* Five lost samples; a connector that is unplugged and reconnected. */
        if ((k >= 300 && k < 305) || (k >= 1000 && k < 1100)) at.torque = nothing / nothing;
        at.counts = (uint16_t)((angle < 0.0f ? angle + 6.2831855f : angle) / COUNT);
        if (k == 1200) { /* an operator acknowledges the fault */
            (void)bowden_pid_acknowledge_f32(&loop.pid);
            (void)bowden_adaptive_acknowledge_f32(&loop.law);
        }
        result = step(&loop, &at);
        if (result < 0) {
            say(bowden_result_text(result));
            return 1;
        }
        /* A drive with a lag, and a joint with friction. */
        drive += 0.5f * (at.pid.command - drive);
        torque = 0.93f * drive - 0.6f * at.velocity;
        if (k % 100 == 0 || result != last) tell(k, &at);
        last = result;
    }
    return 0;
}
