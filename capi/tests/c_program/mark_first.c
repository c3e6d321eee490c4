/* Settings at the end of readable memory: of a struct without its mark, only the mark is read. */
#define _DEFAULT_SOURCE
#include "bowden.h"
#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

#ifndef MAP_ANONYMOUS
#define MAP_ANONYMOUS MAP_ANON
#endif

/* Four bytes, then memory that nobody may read. */
static const void *last_word(uint32_t value) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    char *memory = mmap(NULL, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    uint32_t *word = (uint32_t *)(void *)(memory + page - 8);
    word[0] = value;
    word[1] = value;
    if (memory == MAP_FAILED || mprotect(memory + page, page, PROT_NONE) != 0) return NULL;
    return word;
}

#define INIT(object) \
    do { \
        bowden_##object##_f32 single; \
        bowden_##object##_f64 wide; \
        int of_single = bowden_##object##_init_f32(&single, word, NULL); \
        int of_wide = bowden_##object##_init_f64(&wide, word, NULL); \
        printf("%s %d %d\n", #object, of_single, of_wide); \
    } while (0)

int main(void) {
    const void *word = last_word(0xa5a5a5a5u);
    bowden_iterative_learning_f32 learning;
    float learned[20], unfiltered[20];
    if (word == NULL) return 1;
    INIT(pid);
    INIT(adaptive);
    INIT(observer);
    INIT(rates);
    INIT(edge_velocity);
    INIT(plausible);
    INIT(relay);
    INIT(hysteresis);
    INIT(cable);
    printf("learning %d\n",
           (int)bowden_iterative_learning_init_f32(&learning, word, learned, unfiltered, 20, NULL));
    return 0;
}
