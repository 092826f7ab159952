#include "lattice/distance.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* Samples are taken in blocks of 4 x 4 x 4; seeds are sorted by the block that they lie in. */
enum { BLOCK = 4 };

/* From the middle of a block to its outermost samples, a little rounded up. */
#define BLOCK_REACH 2.5981

typedef float four __attribute__((vector_size(16)));
typedef int32_t four_indexes __attribute__((vector_size(16)));

/* A point of the surface and how this bends there: at t in the tangent plane it has the height
 * t S t / 2 over it. */
typedef struct seed {
    float at[3];
    float normal[3]; /* to where the field is positive */
    float bend[6];   /* S: xx yy zz xy yz zx */
    float trace, determinant;
} seed;

typedef struct work {
    float *field;
    int32_t size;   /* samples along a side */
    int32_t blocks; /* along a side */
    uint8_t *near;  /* [size^3] samples that a seed is made for; then free */
    seed *seeds;    /* by block */
    int32_t *first; /* [blocks^3 + 1] seeds of a block */
    uint64_t *row;  /* [blocks^2] bit x: is there a seed in block x; repeated to fill 64 bits */
    int32_t count;
    four *square;     /* [count] candidates: squares of the way in x to the four samples of a row */
    float *x, *y, *z; /* [count] their place, from the block's first sample */
    int32_t *which;
    float *apart; /* [count] square from the block's middle */
} work;

static int64_t at(const work *w, int32_t i, int32_t j, int32_t k) {
    int32_t mask = w->size - 1;
    return (i & mask) + (int64_t)w->size * ((j & mask) + (int64_t)w->size * (k & mask));
}

/* A seed for every sample that is nearer to the surface than its neighbour on the other side. */
static int32_t mark_seeds(work *w) {
    int32_t n = w->size, marked = 0;
    const float *f = w->field;
    memset(w->near, 0, (size_t)n * n * n);
    for (int32_t k = 0; k < n; k++)
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < n; i++) {
                int64_t a = at(w, i, j, k);
                int64_t next[3] = {at(w, i + 1, j, k), at(w, i, j + 1, k), at(w, i, j, k + 1)};
                for (int axis = 0; axis < 3; axis++)
                    if ((f[a] < 0) != (f[next[axis]] < 0))
                        w->near[fabsf(f[a]) <= fabsf(f[next[axis]]) ? a : next[axis]] = 1;
            }
    for (int64_t a = 0; a < (int64_t)n * n * n; a++)
        marked += w->near[a];
    return marked;
}

static double dot(const double *p, const double *q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

static void apply(double *out, const double *m, const double *v) {
    out[0] = m[0] * v[0] + m[3] * v[1] + m[5] * v[2];
    out[1] = m[3] * v[0] + m[1] * v[1] + m[4] * v[2];
    out[2] = m[5] * v[0] + m[4] * v[1] + m[2] * v[2];
}

/* Gradient and Hessian of the field at a sample: differences of the fourth order, mixed ones of
 * the second. */
static void differences(double *gradient, double *hessian, const work *w, const int32_t *p) {
    const float *f = w->field;
    double here = f[at(w, p[0], p[1], p[2])];
    for (int axis = 0; axis < 3; axis++) {
        double v[5];
        for (int32_t s = -2; s <= 2; s++)
            v[s + 2] =
                f[at(w, p[0] + s * (axis == 0), p[1] + s * (axis == 1), p[2] + s * (axis == 2))];
        gradient[axis] = (8 * (v[3] - v[1]) - (v[4] - v[0])) / 12;
        hessian[axis] = (16 * (v[3] + v[1]) - 30 * here - (v[4] + v[0])) / 12;
    }
    for (int mixed = 0; mixed < 3; mixed++) {
        int a = mixed, b = (mixed + 1) % 3;
        double sum = 0;
        for (int32_t s = -1; s <= 1; s += 2)
            for (int32_t t = -1; t <= 1; t += 2)
                sum +=
                    s * t *
                    f[at(w, p[0] + s * (a == 0) + t * (b == 0), p[1] + s * (a == 1) + t * (b == 1),
                         p[2] + s * (a == 2) + t * (b == 2))];
        hessian[3 + mixed] = sum / 4;
    }
}

/* S = -P H P / |gradient|, P the projection on the tangent plane. */
static void set_bend(seed *s, const double *normal, const double *hessian, double length) {
    double hn[3];
    apply(hn, hessian, normal);
    double nhn = dot(normal, hn), bend[6], minors = 0;
    static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    for (int m = 0; m < 6; m++) {
        int a = row[m], b = column[m];
        bend[m] =
            -(hessian[m] - normal[a] * hn[b] - hn[a] * normal[b] + nhn * normal[a] * normal[b]) /
            length;
        s->bend[m] = (float)bend[m];
    }
    for (int m = 0; m < 3; m++)
        minors += bend[m] * bend[(m + 1) % 3] - bend[3 + m] * bend[3 + m];
    s->trace = (float)(bend[0] + bend[1] + bend[2]);
    s->determinant = (float)minors; /* the third principal curvature is 0 */
}

/* From the sample along the gradient to the surface, by the field's second-order expansion. */
static void make_seed(seed *s, const work *w, const int32_t *sample) {
    double gradient[3], hessian[6], hu[3], unit[3];
    differences(gradient, hessian, w, sample);
    double value = w->field[at(w, sample[0], sample[1], sample[2])];
    double length = sqrt(dot(gradient, gradient));
    length = length > 1e-12 ? length : 1e-12;
    for (int a = 0; a < 3; a++)
        unit[a] = gradient[a] / length;
    apply(hu, hessian, unit);
    double bent = dot(unit, hu), way = 0;
    for (int turn = 0; turn < 4; turn++) {
        double slope = length + way * bent;
        if (slope < 0.25 * length)
            slope = 0.25 * length;
        way -= (value + way * (length + 0.5 * way * bent)) / slope;
        way = way > 1.5 ? 1.5 : way < -1.5 ? -1.5 : way;
    }
    for (int a = 0; a < 3; a++) {
        s->at[a] = (float)(sample[a] + way * unit[a]);
        gradient[a] += way * hu[a];
    }
    double turned = sqrt(dot(gradient, gradient));
    if (turned > 1e-12) {
        length = turned;
        for (int a = 0; a < 3; a++)
            unit[a] = gradient[a] / length;
    }
    for (int a = 0; a < 3; a++)
        s->normal[a] = (float)unit[a];
    set_bend(s, unit, hessian, length);
}

/* Block b covers 4 b - 0.5 to 4 b + 3.5, so that its samples are in its middle. */
static int32_t block_of(work *w, seed *s) {
    int32_t block = 0;
    for (int a = 2; a >= 0; a--) {
        int32_t b = (int32_t)floorf((s->at[a] + 0.5f) / BLOCK);
        int32_t wrapped = b & (w->blocks - 1);
        s->at[a] += (float)((wrapped - b) * BLOCK);
        block = block * w->blocks + wrapped;
    }
    return block;
}

static iso_status make_seeds(work *w) {
    int32_t n = w->size, blocks = w->blocks * w->blocks * w->blocks;
    seed *made;
    int32_t *block;
    ISO_TRY(ISO_ALLOCATE(made, w->count));
    iso_status status = ISO_ALLOCATE(block, w->count);
    if (status != ISO_OK) {
        iso_release(made);
        return status;
    }
    memset(w->first, 0, (size_t)(blocks + 1) * sizeof *w->first);
    int32_t s = 0, sample[3];
    int64_t a = 0;
    for (sample[2] = 0; sample[2] < n; sample[2]++)
        for (sample[1] = 0; sample[1] < n; sample[1]++)
            for (sample[0] = 0; sample[0] < n; sample[0]++, a++)
                if (w->near[a]) {
                    make_seed(&made[s], w, sample);
                    block[s] = block_of(w, &made[s]);
                    w->first[block[s++] + 1]++;
                }
    for (int32_t b = 0; b < blocks; b++)
        w->first[b + 1] += w->first[b];
    for (s = 0; s < w->count; s++)
        w->seeds[w->first[block[s]]++] = made[s];
    for (int32_t b = blocks; b > 0; b--)
        w->first[b] = w->first[b - 1];
    w->first[0] = 0;
    iso_release(made);
    iso_release(block);
    return ISO_OK;
}

static void mark_rows(work *w) {
    for (int32_t r = 0; r < w->blocks * w->blocks; r++) {
        const int32_t *first = w->first + (int64_t)r * w->blocks;
        w->row[r] = 0;
        for (int32_t bit = 0; bit < 64; bit++) {
            int32_t x = bit & (w->blocks - 1);
            w->row[r] |= (uint64_t)(first[x] < first[x + 1]) << bit;
        }
    }
}

/* ---- Nearest seeds ---- */

typedef struct hunt {
    int32_t block[3];
    int32_t count;
    int32_t best;    /* candidate nearest to the middle */
    float nearest;   /* square of its way from there */
    float most;      /* square; what is further is no candidate */
    int32_t last[3]; /* the block that `nearest` and `best` were last found for */
    int32_t is_first;
} hunt;

static void take_block(work *w, hunt *h, int32_t x, int32_t y, int32_t z) {
    int32_t mask = w->blocks - 1, step[3] = {x, y, z};
    int32_t other = 0;
    float shift[3];
    const float middle = 0.5f * (BLOCK - 1);
    for (int a = 2; a >= 0; a--) {
        int32_t b = h->block[a] + step[a];
        other = other * w->blocks + (b & mask);
        /* seeds are where their block is in the box: bring them next to this block's first sample
         */
        shift[a] = (float)(-BLOCK * ((b & mask) - step[a]));
    }
    for (int32_t s = w->first[other]; s < w->first[other + 1]; s++) {
        const float *p = w->seeds[s].at;
        float px = p[0] + shift[0], py = p[1] + shift[1], pz = p[2] + shift[2];
        float dx = px - middle, dy = py - middle, dz = pz - middle;
        float apart = dx * dx + dy * dy + dz * dz;
        if (apart > h->most)
            continue;
        int32_t c = h->count++;
        w->x[c] = px;
        w->y[c] = py;
        w->z[c] = pz;
        w->which[c] = s;
        w->apart[c] = apart;
        if (apart < h->nearest) {
            float reach = sqrtf(apart) + 2 * (float)BLOCK_REACH;
            h->nearest = apart, h->best = c, h->most = reach * reach;
        }
    }
}

/* Square of the way from the middle of a block to another, `step` blocks on along each axis. */
static int32_t gap(int32_t x, int32_t y, int32_t z) {
    int32_t step[3] = {abs(x), abs(y), abs(z)}, square = 0;
    for (int a = 0; a < 3; a++)
        if (step[a] > 0)
            square += (BLOCK * step[a] - BLOCK / 2) * (BLOCK * step[a] - BLOCK / 2);
    return square;
}

/* The blocks of a row that hold seeds and may be near enough, `y` and `z` rows on. */
static void take_row(work *w, hunt *h, int32_t y, int32_t z) {
    int32_t mask = w->blocks - 1, half = w->blocks / 2;
    float left = h->most - (float)gap(0, y, z);
    if (left < 0)
        return;
    int32_t reach = (int32_t)((sqrtf(left) + 0.5f * BLOCK) / BLOCK);
    int32_t from = reach < half ? -reach : -half, to = reach < half ? reach : half - 1;
    uint64_t bits = w->row[((h->block[1] + y) & mask) + w->blocks * ((h->block[2] + z) & mask)];
    unsigned turn = (unsigned)(h->block[0] + from) & 63;
    if (turn > 0)
        bits = bits >> turn | bits << (64 - turn);
    bits &= ~(uint64_t)0 >> (63 - (to - from));
    for (; bits != 0; bits &= bits - 1) {
        int32_t x = from + __builtin_ctzll(bits);
        if ((float)gap(x, y, z) <= h->most)
            take_block(w, h, x, y, z);
    }
}

/* The bisector of a candidate and the one that is nearest to the block's middle must meet the
 * block, or else the candidate is nobody's nearest. */
static void keep_candidates(work *w, hunt *h) {
    float x = w->x[h->best], y = w->y[h->best], z = w->z[h->best];
    int32_t kept = 0;
    for (int32_t c = 0; c < h->count; c++) {
        float way = fabsf(w->x[c] - x) + fabsf(w->y[c] - y) + fabsf(w->z[c] - z);
        if (w->apart[c] - h->nearest > (BLOCK - 1) * way + 1e-3f)
            continue;
        for (int i = 0; i < BLOCK; i++)
            w->square[kept][i] = (w->x[c] - (float)i) * (w->x[c] - (float)i);
        w->x[kept] = w->x[c];
        w->y[kept] = w->y[c];
        w->z[kept] = w->z[c];
        w->which[kept++] = w->which[c];
    }
    h->count = kept;
}

/* 0 -1 1 -2 2 ... */
static int32_t outwards(int32_t i) {
    return i % 2 ? -(i + 1) / 2 : i / 2;
}

/* No seed is further from this block than from the last one, plus the way between them. */
static float bound_of(const work *w, const hunt *h) {
    int32_t square = 0;
    if (h->is_first)
        return (float)w->size;
    for (int a = 0; a < 3; a++) {
        int32_t way = abs(h->block[a] - h->last[a]);
        way = way < w->blocks - way ? way : w->blocks - way;
        square += way * way;
    }
    return sqrtf(h->nearest) + BLOCK * sqrtf((float)square) + 1e-3f;
}

/* Every seed that may be the nearest of any of the block's samples. Each block of the period is
 * looked at once at most, where it is nearest. */
static void find_candidates(work *w, hunt *h) {
    float reach = bound_of(w, h) + 2 * (float)BLOCK_REACH;
    int32_t half = w->blocks / 2, rows = (int32_t)((reach + 0.5f * BLOCK) / BLOCK);
    int32_t from = rows < half ? -rows : -half, to = rows < half ? rows : half - 1;
    h->count = 0;
    h->nearest = HUGE_VALF;
    h->most = reach * reach;
    /* from the middle outwards, so that what is far is soon known to be */
    for (int32_t k = 0; k <= to - from; k++)
        for (int32_t j = 0; j <= to - from; j++)
            take_row(w, h, outwards(j), outwards(k));
    memcpy(h->last, h->block, sizeof h->last);
    h->is_first = 0;
    keep_candidates(w, h);
}

/* Keep candidate c where it is nearer than what was. */
static inline void keep_nearer(four *best, four_indexes *found, four d, int32_t c) {
    four_indexes less = d < *best;
    *best = (four)(((four_indexes)d & less) | ((four_indexes)*best & ~less));
    *found = (less & c) | (*found & ~less);
}

/* The nearest candidate of each of the 16 samples of a plane of the block. Four rows at once: the
 * processor has four chains of comparisons to work on instead of one to wait for. */
static void nearest_of_plane(four square[BLOCK], four_indexes found[BLOCK], const work *w,
                             int32_t count, int z) {
    const four far = {HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF};
    const four_indexes none = {0, 0, 0, 0};
    four b0 = far, b1 = far, b2 = far, b3 = far;
    four_indexes f0 = none, f1 = none, f2 = none, f3 = none;
    for (int32_t c = 0; c < count; c++) {
        float y = w->y[c], dz = w->z[c] - (float)z, rest = dz * dz;
        four x = w->square[c];
        keep_nearer(&b0, &f0, x + (y * y + rest), c);
        keep_nearer(&b1, &f1, x + ((y - 1) * (y - 1) + rest), c);
        keep_nearer(&b2, &f2, x + ((y - 2) * (y - 2) + rest), c);
        keep_nearer(&b3, &f3, x + ((y - 3) * (y - 3) + rest), c);
    }
    square[0] = b0, square[1] = b1, square[2] = b2, square[3] = b3;
    found[0] = f0, found[1] = f1, found[2] = f2, found[3] = f3;
}

/* Distance from a surface that is known to the second order at a seed nearby: with s over its
 * tangent plane and t along it, s - t S (1 - s S)^-1 t / 2. Near a centre of curvature that says
 * nothing, and the seed itself has to do; never further than the seed, nor much nearer. */
static float refine(const seed *s, const float *to, float square) {
    float height = to[0] * s->normal[0] + to[1] * s->normal[1] + to[2] * s->normal[2];
    float t[3], b[3];
    for (int a = 0; a < 3; a++)
        t[a] = to[a] - height * s->normal[a];
    b[0] = s->bend[0] * t[0] + s->bend[3] * t[1] + s->bend[5] * t[2];
    b[1] = s->bend[3] * t[0] + s->bend[1] * t[1] + s->bend[4] * t[2];
    b[2] = s->bend[5] * t[0] + s->bend[4] * t[1] + s->bend[2] * t[2];
    float tbt = t[0] * b[0] + t[1] * b[1] + t[2] * b[2];
    float bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    float turn = height * s->trace, divisor = 1 - turn + height * height * s->determinant;
    if (divisor < 0.05f || turn > 1.9f)
        return sqrtf(square);
    float d = fabsf(height - 0.5f * (tbt * (1 - turn) + height * bb) / divisor);
    if (d * d > square)
        return sqrtf(square);
    return d * d < square - 1.5f ? sqrtf(square - 1.5f) : d;
}

static void fill_block(work *w, hunt *h) {
    find_candidates(w, h);
    for (int z = 0; z < BLOCK; z++) {
        four square[BLOCK];
        four_indexes found[BLOCK];
        nearest_of_plane(square, found, w, h->count, z);
        for (int y = 0; y < BLOCK; y++) {
            float *f = w->field +
                       at(w, BLOCK * h->block[0], BLOCK * h->block[1] + y, BLOCK * h->block[2] + z);
            for (int i = 0; i < BLOCK; i++) {
                int32_t c = found[y][i];
                float to[3] = {(float)i - w->x[c], (float)y - w->y[c], (float)z - w->z[c]};
                f[i] = copysignf(refine(&w->seeds[w->which[c]], to, square[y][i]), f[i]);
            }
        }
    }
}

/* ---- Symmetry ---- */

/* Image `turn` of a block: turned about the diagonal turn % 3 times, then half a period on. */
static void image_of(int32_t *image, const work *w, const int32_t *block, int turn) {
    int32_t half = turn >= 3 ? w->blocks / 2 : 0;
    for (int a = 0; a < 3; a++)
        image[a] = (block[(a + turn) % 3] + half) & (w->blocks - 1);
}

static int64_t rank_of(const work *w, const int32_t *block) {
    return block[0] + (int64_t)w->blocks * (block[1] + (int64_t)w->blocks * block[2]);
}

static void copy_block(work *w, const int32_t *block, int turn, float sign) {
    int32_t image[3], p[3], q[3];
    image_of(image, w, block, turn);
    for (p[2] = 0; p[2] < BLOCK; p[2]++)
        for (p[1] = 0; p[1] < BLOCK; p[1]++)
            for (p[0] = 0; p[0] < BLOCK; p[0]++) {
                for (int a = 0; a < 3; a++)
                    q[a] = BLOCK * image[a] + p[(a + turn) % 3];
                w->field[at(w, q[0], q[1], q[2])] =
                    sign * w->field[at(w, BLOCK * block[0] + p[0], BLOCK * block[1] + p[1],
                                       BLOCK * block[2] + p[2])];
            }
}

static void fill_blocks(work *w, iso_field_symmetry symmetry) {
    hunt h = {.is_first = 1};
    int turns = symmetry == ISO_FIELD_ANY ? 1 : 6;
    int32_t n = w->blocks, image[3];
    for (h.block[2] = 0; h.block[2] < n; h.block[2]++)
        for (h.block[1] = 0; h.block[1] < n; h.block[1]++)
            for (h.block[0] = 0; h.block[0] < n; h.block[0]++) {
                int is_first = 1;
                for (int turn = 1; turn < turns; turn++) {
                    image_of(image, w, h.block, turn);
                    is_first &= rank_of(w, h.block) <= rank_of(w, image);
                }
                if (!is_first)
                    continue;
                fill_block(w, &h);
                for (int turn = 1; turn < turns; turn++) {
                    image_of(image, w, h.block, turn);
                    if (rank_of(w, image) != rank_of(w, h.block))
                        copy_block(w, h.block, turn,
                                   turn >= 3 && symmetry == ISO_FIELD_ODD ? -1.0f : 1.0f);
                }
            }
}

static iso_status run(work *w, iso_arena *arena, iso_field_symmetry symmetry) {
    int64_t samples = (int64_t)w->size * w->size * w->size;
    int64_t blocks = (int64_t)w->blocks * w->blocks * w->blocks;
    ISO_TRY(ISO_PUSH(w->near, arena, samples));
    w->count = mark_seeds(w);
    if (w->count == 0)
        return iso_fail(ISO_BAD_CONFIG, "the lattice's cell is all solid or all void");
    ISO_TRY(ISO_PUSH(w->first, arena, blocks + 1));
    ISO_TRY(ISO_PUSH(w->row, arena, (int64_t)w->blocks * w->blocks));
    ISO_TRY(ISO_PUSH(w->seeds, arena, w->count));
    ISO_TRY(ISO_PUSH(w->square, arena, w->count));
    ISO_TRY(ISO_PUSH(w->x, arena, w->count));
    ISO_TRY(ISO_PUSH(w->y, arena, w->count));
    ISO_TRY(ISO_PUSH(w->z, arena, w->count));
    ISO_TRY(ISO_PUSH(w->which, arena, w->count));
    ISO_TRY(ISO_PUSH(w->apart, arena, w->count));
    ISO_TRY(make_seeds(w));
    mark_rows(w);
    fill_blocks(w, symmetry);
    return ISO_OK;
}

iso_status distance_from_field(float *field, int32_t size, iso_field_symmetry symmetry) {
    work w = {.field = field, .size = size, .blocks = size / BLOCK};
    iso_arena arena = {0};
    iso_status status = run(&w, &arena, symmetry);
    iso_arena_free(&arena);
    return status;
}
