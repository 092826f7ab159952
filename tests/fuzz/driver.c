/* Without libFuzzer: run an entry on every seed, then on damaged copies of them. Nothing guides it,
 * but it needs no compiler of its own and does the same on every machine.
 *
 *     fuzz-x [--runs N | --seconds N] SEED... */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

enum { LONGEST = 1 << 14, MOST_SEEDS = 256 };

typedef struct seed {
    size_t size;
    uint8_t bytes[LONGEST];
} seed;

static uint64_t state = 88172645463325252u;

static uint64_t number(void) {
    state ^= state << 13;
    state ^= state >> 7;
    return state ^= state << 17;
}

static size_t below(size_t bound) {
    return bound > 0 ? (size_t)(number() % bound) : 0;
}

/* Numbers and separators that readers trip over. */
static const char *const awkward[] = {"0", "-1",  "nan", "inf", "1e999", "-0",         ".",
                                      " ", "\n",  "\r",  ";",   "\t",    "4294967295", "1e-45",
                                      "E", "G92", "=",   "[",   "\"",    "2147483648"};

static void insert(seed *s, size_t at, const void *bytes, size_t size) {
    if (s->size + size > LONGEST)
        return;
    memmove(s->bytes + at + size, s->bytes + at, s->size - at);
    memcpy(s->bytes + at, bytes, size);
    s->size += size;
}

static void damage(seed *s) {
    uint8_t piece[64];
    size_t at = below(s->size), length = below(sizeof piece);
    const char *text = awkward[below(sizeof awkward / sizeof *awkward)];
    if (length > s->size - at)
        length = s->size - at;
    switch (below(8)) {
    case 0:
    case 1:
        if (s->size > 0)
            s->bytes[at] ^= (uint8_t)(1u << below(8));
        break;
    case 2:
        if (s->size > 0)
            s->bytes[at] = (uint8_t)number();
        break;
    case 3: /* lose a piece */
        memmove(s->bytes + at, s->bytes + at + length, s->size - at - length);
        s->size -= length;
        break;
    case 4: /* a piece twice */
        memcpy(piece, s->bytes + at, length);
        insert(s, below(s->size + 1), piece, length);
        break;
    case 5:
        insert(s, below(s->size + 1), text, strlen(text));
        break;
    case 6: /* four bytes at once: floats, counts */
        for (size_t k = at; k < at + 4 && k < s->size; k++)
            s->bytes[k] = (uint8_t)(number() % 3 == 0 ? 0xff : number());
        break;
    default: /* end early */
        if (below(4) == 0)
            s->size = at;
    }
}

static bool load(seed *s, const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    s->size = fread(s->bytes, 1, LONGEST, file);
    fclose(file);
    return true;
}

int main(int count, char **word) {
    static seed seeds[MOST_SEEDS], changed;
    long runs = 1000, seconds = 0;
    int seed_count = 0;
    for (int i = 1; i < count; i++) {
        if (i + 1 < count && strcmp(word[i], "--runs") == 0)
            runs = atol(word[++i]);
        else if (i + 1 < count && strcmp(word[i], "--seconds") == 0)
            seconds = atol(word[++i]);
        else if (seed_count == MOST_SEEDS || !load(&seeds[seed_count++], word[i])) {
            fprintf(stderr, "%s: can't be read, or one seed too many\n", word[i]);
            return 2;
        }
    }
    if (seed_count == 0)
        seed_count = 1; /* the empty one */
    for (int i = 0; i < seed_count; i++)
        LLVMFuzzerTestOneInput(seeds[i].bytes, seeds[i].size);
    time_t end = time(NULL) + seconds;
    long done = 0;
    for (; seconds > 0 ? time(NULL) < end : done < runs; done++) {
        const seed *from = &seeds[below((size_t)seed_count)];
        memcpy(changed.bytes, from->bytes, from->size);
        changed.size = from->size;
        for (size_t k = below(6) + 1; k > 0; k--)
            damage(&changed);
        LLVMFuzzerTestOneInput(changed.bytes, changed.size);
    }
    printf("%d seeds, %ld damaged copies, no complaint\n", seed_count, done);
    return 0;
}
