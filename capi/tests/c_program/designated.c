/* Settings by name: without the macro they are refused, with it they are taken. */
#include "bowden.h"
#include <stdio.h>

int main(void) {
    const bowden_pid_settings_f32 named = {
        .k_p = 30.0f,
        .k_i = 18.0f,
        .limits = {.low = -20.0f, .high = 60.0f, .slew = 0.0f},
        .longest_dt = 0.005f,
        .fallback = {.after = 20, .weight = 4, .command = 0.0f}};
    bowden_pid_settings_f32 settings = BOWDEN_PID_SETTINGS_F32_INIT;
    bowden_pid_f32 pid;
    bowden_about about;
    int result = bowden_pid_init_f32(&pid, &named, &about);
    printf("%d %s\n", result, about.text);
    settings.k_p = 30.0f;
    settings.k_i = 18.0f;
    settings.limits.low = -20.0f;
    settings.limits.high = 60.0f;
    settings.longest_dt = 0.005f;
    settings.fallback.after = 20;
    result = bowden_pid_init_f32(&pid, &settings, &about);
    printf("%d %s\n", result, about.text);
    return 0;
}
