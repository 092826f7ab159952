#include "lattice/segments.h"

#include <math.h>

#include "base/memory.h"

/* Blocks of 16^3 samples choose what is near, blocks of 4^3 choose from that. */
enum { OUTER = 16, INNER = 4 };

/* From a block's middle to its outermost samples, a little rounded up. */
#define OUTER_REACH 12.991f
#define INNER_REACH 2.5981f

typedef float four __attribute__((vector_size(16)));
typedef int32_t four_bits __attribute__((vector_size(16)));

/* A segment with what its distance takes. */
typedef struct image {
    float from[3], way[3], shorten; /* 1 / square of its length */
} image;

typedef struct work {
    float *distance;
    int32_t size;
    const image *all;
    image *outer, *inner; /* those near a block */
    float *apart;         /* from a block's middle */
    int32_t all_count, outer_count, inner_count;
} work;

static float square_from(const image *s, const float *p) {
    float x = p[0] - s->from[0], y = p[1] - s->from[1], z = p[2] - s->from[2];
    float t = (x * s->way[0] + y * s->way[1] + z * s->way[2]) * s->shorten;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    x -= t * s->way[0], y -= t * s->way[1], z -= t * s->way[2];
    return x * x + y * y + z * z;
}

/* Those of `from` that may be the nearest of some point within `reach` of the middle. */
static int32_t choose(image *out, float *apart, const image *from, int32_t count,
                      const float *middle, float reach) {
    float nearest = HUGE_VALF;
    for (int32_t s = 0; s < count; s++) {
        apart[s] = square_from(&from[s], middle);
        nearest = apart[s] < nearest ? apart[s] : nearest;
    }
    float most = sqrtf(nearest) + 2 * reach;
    int32_t kept = 0;
    for (int32_t s = 0; s < count; s++)
        if (apart[s] <= most * most)
            out[kept++] = from[s];
    return kept;
}

static four smaller(four a, four b) {
    four_bits less = a < b;
    return (four)(((four_bits)a & less) | ((four_bits)b & ~less));
}

static void fill_row(float *row, const work *w, float x, float y, float z) {
    four best = {HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF};
    const four places = {x, x + 1, x + 2, x + 3}, none = {0, 0, 0, 0}, whole = {1, 1, 1, 1};
    for (int32_t i = 0; i < w->inner_count; i++) {
        const image *s = &w->inner[i];
        four px = places - s->from[0];
        float py = y - s->from[1], pz = z - s->from[2];
        four t = (px * s->way[0] + (py * s->way[1] + pz * s->way[2])) * s->shorten;
        t = smaller(whole, none - smaller(none, none - t));
        four dx = px - t * s->way[0], dy = py - t * s->way[1], dz = pz - t * s->way[2];
        best = smaller(dx * dx + dy * dy + dz * dz, best);
    }
    for (int i = 0; i < INNER; i++)
        row[i] = sqrtf(best[i]);
}

static void fill_inner(work *w, const int32_t *first) {
    float middle[3];
    for (int a = 0; a < 3; a++)
        middle[a] = (float)first[a] + 0.5f * (INNER - 1);
    w->inner_count = choose(w->inner, w->apart, w->outer, w->outer_count, middle, INNER_REACH);
    for (int32_t k = first[2]; k < first[2] + INNER; k++)
        for (int32_t j = first[1]; j < first[1] + INNER; j++)
            fill_row(w->distance + first[0] + (int64_t)w->size * (j + (int64_t)w->size * k), w,
                     (float)first[0], (float)j, (float)k);
}

static void fill_outer(work *w, const int32_t *first) {
    float middle[3];
    int32_t inner[3];
    for (int a = 0; a < 3; a++)
        middle[a] = (float)first[a] + 0.5f * (OUTER - 1);
    w->outer_count = choose(w->outer, w->apart, w->all, w->all_count, middle, OUTER_REACH);
    for (inner[2] = first[2]; inner[2] < first[2] + OUTER; inner[2] += INNER)
        for (inner[1] = first[1]; inner[1] < first[1] + OUTER; inner[1] += INNER)
            for (inner[0] = first[0]; inner[0] < first[0] + OUTER; inner[0] += INNER)
                fill_inner(w, inner);
}

/* A segment once for every period around: those that come as near to the box as half a period are
 * all that can be nearest to anything in it, if a segment of each kind is in each period. */
static int32_t make_images(image *out, const iso_segment *segment, int32_t count, int32_t size) {
    int32_t made = 0;
    const float reach = (float)size;
    for (int32_t i = 0; i < count; i++)
        for (int32_t period = 0; period < 125; period++) {
            const iso_segment *s = &segment[i];
            image m;
            int outside = 0;
            int32_t step[3] = {period % 5 - 2, period / 5 % 5 - 2, period / 25 - 2};
            float square = 0;
            for (int a = 0; a < 3; a++) {
                m.from[a] = s->from[a] + (float)(step[a] * size);
                m.way[a] = s->way[a];
                square += m.way[a] * m.way[a];
                float low = m.way[a] < 0 ? m.from[a] + m.way[a] : m.from[a];
                float high = m.way[a] < 0 ? m.from[a] : m.from[a] + m.way[a];
                outside |= high < -0.5f * reach || low > 1.5f * reach;
            }
            m.shorten = 1 / square;
            if (!outside)
                out[made++] = m;
        }
    return made;
}

static iso_status run(work *w, iso_arena *arena, const iso_segment *segment, int32_t count) {
    image *all;
    ISO_TRY(ISO_PUSH(all, arena, 125 * (int64_t)count));
    w->all = all;
    w->all_count = make_images(all, segment, count, w->size);
    ISO_TRY(ISO_PUSH(w->outer, arena, w->all_count));
    ISO_TRY(ISO_PUSH(w->inner, arena, w->all_count));
    ISO_TRY(ISO_PUSH(w->apart, arena, w->all_count));
    int32_t first[3];
    for (first[2] = 0; first[2] < w->size; first[2] += OUTER)
        for (first[1] = 0; first[1] < w->size; first[1] += OUTER)
            for (first[0] = 0; first[0] < w->size; first[0] += OUTER)
                fill_outer(w, first);
    return ISO_OK;
}

iso_status distance_from_segments(float *distance, int32_t size, const iso_segment *segment,
                                  int32_t count) {
    work w = {.distance = distance, .size = size};
    iso_arena arena = {0};
    iso_status status = run(&w, &arena, segment, count);
    iso_arena_free(&arena);
    return status;
}
