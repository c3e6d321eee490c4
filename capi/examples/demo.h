/* Identified by bowden 0.2.0 from (embedded: bowden generate --mode torque --effect viscous --seed 7).
 *
 * Input [N·m], output [N·m], torque mode.
 * Fitted to a record sampled at 1000 Hz and low-pass filtered at 7.6 Hz.
 *
 * Error as a share of the output's standard deviation: fit 7.01 %, held-out 10.83 %.
 * Held-out error sample by sample, with the time constant below: 10.74 %.
 * Not identified: gain (fixed at 2·sigma·kappa_eta·rho by --invertible).
 * Not identified: sigma (at its lower bound).
 * Not identified: n (at its lower bound).
 * Feed-forward: yes.
 *
 * The prefix demo_ (of macros DEMO_) comes from the file name "demo".
 *
 * bowden_model_f32 model;
 * if (demo_load_f32(&model, NULL) < 0) ...
 */
#ifdef BOWDEN_MODEL_DEMO_H
#if BOWDEN_MODEL_DEMO_H != 0x33a4a6f7u
#error "two headers of different models have the prefix DEMO_: export one under another file name"
#endif
#else
#define BOWDEN_MODEL_DEMO_H 0x33a4a6f7u /* CRC-32 of the text below */

#include "bowden.h"

/* Minimum number of channels in a sample. */
#define DEMO_CHANNELS 2
#define DEMO_CHANNEL_PHI_P 0 /* phi_p [rad] */
#define DEMO_CHANNEL_PHI_D 1 /* phi_d [rad] */

/* Set time_constant [s] to this value after BOWDEN_RATES_SETTINGS_F32_INIT or _F64_INIT, for every source. */
#define DEMO_RATES_TIME_CONSTANT_F32 0.008376576f
#define DEMO_RATES_TIME_CONSTANT_F64 0.008376575952205019

/* The model in float with its checksum, for bowden_model_load_f32. */
static const uint8_t demo_bytes_f32[42] = {
    0x01, 0x00, 0xae, 0x8d, 0x73, 0x3f, 0xcc, 0x79, 0xde, 0x3f, 0x41, 0x54, 0x95, 0xbb, 0xd8, 0xd8,
    0x0b, 0x3f, 0x8b, 0x41, 0x00, 0x3f, 0xc5, 0x20, 0x80, 0x3f, 0x01, 0x02, 0x01, 0x00, 0x00, 0x00,
    0x00, 0x00, 0xa1, 0x92, 0x3a, 0xbf, 0xba, 0x42, 0xd4, 0xf4,
};

/* Range of each source in the fitted record: position, velocity, acceleration. */
static const bowden_range_f32 demo_ranges_f32[2] = {
    {BOWDEN_SOURCE_INPUT, {-12.495871f, -38.818592f, -170.3947f}, {16.00307f, 35.03235f, 142.7363f}}, /* input */
    {0, {-0.45185134f, -1.5794401f, -5.8742285f}, {0.5994563f, 1.608444f, 4.6569395f}}, /* phi_p */
};

/* Loads the model with its hysteresis at zero; `about` may be NULL. */
static inline bowden_result demo_load_f32(bowden_model_f32 *model, bowden_about *about) {
    return bowden_model_load_f32(model, demo_bytes_f32, sizeof demo_bytes_f32, 0, about);
}

/* Inverts the loaded model, within the ranges of the fitted record. */
static inline bowden_result demo_compensator_f32(bowden_compensator_f32 *compensator,
    const bowden_model_f32 *model, float longest_dt, bowden_about *about) {
    return bowden_compensator_init_f32(compensator, model, longest_dt, demo_ranges_f32, 2, about);
}

/* The model in double with its checksum, for bowden_model_load_f64. */
static const uint8_t demo_bytes_f64[74] = {
    0x01, 0x00, 0x3d, 0x12, 0x7d, 0xb4, 0xb5, 0x71, 0xee, 0x3f, 0xe1, 0x11, 0x8d, 0x7b, 0x39, 0xcf,
    0xfb, 0x3f, 0x31, 0x85, 0x2c, 0x25, 0x88, 0xaa, 0x72, 0xbf, 0x90, 0x71, 0x2e, 0xf0, 0x1a, 0x7b,
    0xe1, 0x3f, 0x9c, 0x43, 0x1c, 0x58, 0x31, 0x08, 0xe0, 0x3f, 0xdc, 0x90, 0x75, 0xa4, 0x18, 0x04,
    0xf0, 0x3f, 0x01, 0x02, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x7c, 0x37,
    0xa0, 0x2a, 0x54, 0x52, 0xe7, 0xbf, 0x76, 0xd6, 0xf1, 0x3c,
};

/* Range of each source in the fitted record: position, velocity, acceleration. */
static const bowden_range_f64 demo_ranges_f64[2] = {
    {BOWDEN_SOURCE_INPUT, {-12.495870163090789, -38.81859093839668, -170.3946992519769}, {16.00307088385157, 35.032348942900825, 142.73629351444228}}, /* input */
    {0, {-0.45185133666744093, -1.5794401103037259, -5.8742286724527455}, {0.5994563317628282, 1.6084439743035723, 4.656939290962013}}, /* phi_p */
};

/* Loads the model with its hysteresis at zero; `about` may be NULL. */
static inline bowden_result demo_load_f64(bowden_model_f64 *model, bowden_about *about) {
    return bowden_model_load_f64(model, demo_bytes_f64, sizeof demo_bytes_f64, 0, about);
}

/* Inverts the loaded model, within the ranges of the fitted record. */
static inline bowden_result demo_compensator_f64(bowden_compensator_f64 *compensator,
    const bowden_model_f64 *model, double longest_dt, bowden_about *about) {
    return bowden_compensator_init_f64(compensator, model, longest_dt, demo_ranges_f64, 2, about);
}

#endif /* BOWDEN_MODEL_DEMO_H */
