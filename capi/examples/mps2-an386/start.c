/* Start-up of the board, and a log through the debugger: what a project of yours has already. */
#include <stddef.h>
#include <stdint.h>

extern uint32_t stack_top, data_begin, data_end, data_stored, bss_begin, bss_end;
int main(void);
void reset(void);
void say(const char *line);

/* A call of the debugger (semihosting): SYS_WRITE0 writes a text, SYS_EXIT_EXTENDED ends. */
static void debugger(uint32_t what, const void *with) {
    register uint32_t r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = with;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void say(const char *line) {
    debugger(4, line);
    debugger(4, "\n");
}

static void leave(uint32_t status) {
    uint32_t told[2];
    told[0] = 0x20026; /* ended by itself */
    told[1] = status;
    for (;;) debugger(0x20, told);
}

static void fault(void) {
    leave(9);
}

void reset(void) {
    uint32_t *to, *from = &data_stored;
    *(volatile uint32_t *)0xe000ed88 |= 0xfu << 20; /* CPACR: the float unit */
    __asm__ volatile("dsb\n isb");
    for (to = &data_begin; to < &data_end;) *to++ = *from++;
    for (to = &bss_begin; to < &bss_end;) *to++ = 0;
    leave((uint32_t)main());
}

typedef void handler(void);
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    handler *reset, *faults[5];
} vectors = {&stack_top, reset, {fault, fault, fault, fault, fault}};
