/* The rows of a test vector through an exported model, in both precisions: bits of the outputs. */
#include "demo.h"
#include <stdio.h>
#include <string.h>

/* dt, input, its rates, load, phi_p, its rates, phi_d, its rates. */
static const double rows[][11] = {ROWS};

int main(void) {
    bowden_model_f32 single;
    bowden_model_f64 wide;
    size_t k;
    if (demo_load_f32(&single, NULL) < 0 || demo_load_f64(&wide, NULL) < 0) return 1;
    for (k = 0; k < sizeof rows / sizeof *rows; k++) {
        const double *r = rows[k];
        bowden_motion_f64 own[2] = {{r[5], r[6], r[7]}, {r[8], r[9], r[10]}};
        bowden_motion_f32 short_own[2] = {{(float)r[5], (float)r[6], (float)r[7]},
                                          {(float)r[8], (float)r[9], (float)r[10]}};
        bowden_model_sample_f64 at = {r[0], {r[1], r[2], r[3]}, r[4], own, 2};
        bowden_model_sample_f32 short_at = {
            (float)r[0], {(float)r[1], (float)r[2], (float)r[3]}, (float)r[4], short_own, 2};
        float short_y;
        double y;
        uint32_t short_bits;
        uint64_t bits;
        if (bowden_model_step_f32(&single, &short_at, &short_y) != BOWDEN_RESULT_OK) return 2;
        if (bowden_model_step_f64(&wide, &at, &y) != BOWDEN_RESULT_OK) return 3;
        memcpy(&short_bits, &short_y, sizeof short_bits);
        memcpy(&bits, &y, sizeof bits);
        printf("%08lx %08lx%08lx\n", (unsigned long)short_bits, (unsigned long)(bits >> 32),
               (unsigned long)(bits & 0xffffffff));
    }
    return 0;
}
