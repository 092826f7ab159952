/* Structures of voxels out of a file: its box becomes one cell, stretched to a cube. */
#include "lattice/family.h"

#include <math.h>

#include "base/memory.h"
#include "lattice/distance.h"
#include "lattice/voxel.h"
#include "solid/volume.h"

/* Samples along a side of the table, by the file's: two or more a voxel as far as that goes. */
enum { SIZE_LEAST = 64, SIZE_MOST = 256 };

/* Values of a distance grid are linear from voxel to voxel. Between voxels that are black or white
 * they step: taken for means over half a voxel, then blurred by a third of one and by no less than
 * two thirds of a sample, so that the surface between them is smooth and bars of one voxel stay. */
#define WIDTH_DISTANCE 1.0
#define WIDTH_STEP 0.5
#define BLUR_VOXELS 0.35
#define BLUR_SAMPLES 0.7

/* A file's voxels, one plane after the other. */
typedef struct stack {
    int32_t size[3];
    uint8_t *grey;      /* of pictures, else NULL */
    iso_volume *volume; /* of a grid, else NULL */
    iso_volume_info info;
    iso_vec3 *point; /* [size0] of a row of it */
    double *value;   /* [size0] there */
    float least, most;
} stack;

/* Where the samples of one axis get their values from: voxels first[i] .. first[i] + count - 1,
 * which wrap. */
typedef struct window {
    int32_t count;
    int32_t *first; /* [samples] */
    float *weight;  /* [samples * count] */
} window;

static int is_grid(const char *path) {
    size_t length = strlen(path);
    return length > 4 && strcmp(path + length - 4, ".vdb") == 0;
}

static int is_distance(const stack *s) {
    return s->volume && s->info.is_distance;
}

static iso_status open_grid(stack *s, const char *path) {
    ISO_TRY(volume_read(&s->volume, path, NULL));
    volume_info(&s->info, s->volume);
    const iso_vec3 *low = &s->info.min, *high = &s->info.max;
    double way[3] = {high->x - low->x, high->y - low->y, high->z - low->z};
    for (int a = 0; a < 3; a++) {
        double count = floor(way[a] / s->info.voxel + 1.5);
        if (!(count >= 1 && count <= 1e5))
            return iso_fail(ISO_UNREADABLE, "%s: a box of %g voxels can't be a lattice's cell",
                            path, count);
        s->size[a] = (int32_t)count;
    }
    ISO_TRY(ISO_ALLOCATE(s->point, s->size[0]));
    return ISO_ALLOCATE(s->value, s->size[0]);
}

static iso_status open_stack(stack *s, const char *path) {
    if (!path || !*path)
        return iso_fail(ISO_BAD_CONFIG, "lattice_file is empty: voxel_file needs a .vdb grid, or a "
                                        "folder or pattern of grey pictures");
    s->least = HUGE_VALF;
    s->most = -HUGE_VALF;
    return is_grid(path) ? open_grid(s, path) : volume_read_pictures(&s->grey, s->size, path);
}

static void close_stack(stack *s) {
    iso_release(s->grey);
    iso_release(s->point);
    iso_release(s->value);
    if (s->volume)
        volume_free(s->volume);
}

static iso_status read_row(float *row, stack *s, int32_t y, int32_t z) {
    int64_t start = s->size[0] * (y + (int64_t)s->size[1] * z);
    if (s->volume) {
        const iso_vec3 *low = &s->info.min;
        for (int32_t i = 0; i < s->size[0]; i++)
            s->point[i] = (iso_vec3){low->x + i * s->info.voxel, low->y + y * s->info.voxel,
                                     low->z + z * s->info.voxel};
        ISO_TRY(volume_sample(s->value, s->volume, s->point, s->size[0]));
    }
    for (int32_t i = 0; i < s->size[0]; i++) {
        row[i] = s->volume ? (float)s->value[i] : (float)s->grey[start + i];
        if (!(fabsf(row[i]) < HUGE_VALF))
            return iso_fail(ISO_UNREADABLE,
                            "the lattice's file has no finite value at voxel %d "
                            "%d %d",
                            i, y, z);
        s->least = row[i] < s->least ? row[i] : s->least;
        s->most = row[i] > s->most ? row[i] : s->most;
    }
    return ISO_OK;
}

/* Means over `width` voxels, or a sample's if that is wider, so that nothing is left out. */
static iso_status make_window(window *out, iso_arena *arena, double width, const int32_t size[2]) {
    int32_t voxels = size[0], samples = size[1];
    double ratio = (double)voxels / samples, half = 0.5 * (ratio > width ? ratio : width);
    out->count = (int32_t)(2 * half) + 2;
    ISO_TRY(ISO_PUSH(out->first, arena, samples));
    ISO_TRY(ISO_PUSH(out->weight, arena, (int64_t)samples * out->count));
    for (int32_t i = 0; i < samples; i++) {
        double from = i * ratio - half, to = i * ratio + half;
        out->first[i] = (int32_t)floor(from);
        for (int32_t v = 0; v < out->count; v++) {
            double low = out->first[i] + v, high = low + 1;
            low = low > from ? low : from;
            high = high < to ? high : to;
            out->weight[(int64_t)i * out->count + v] =
                (float)(high > low ? (high - low) / (to - from) : 0);
        }
    }
    return ISO_OK;
}

static int32_t wrapped(int32_t a, int32_t length) {
    a %= length;
    return a < 0 ? a + length : a;
}

/* sums[j][i] += the row's share of every row of samples that it belongs to. `row` has the voxels,
 * `line` room for its samples. */
static void add_row(float *sums, const float *row, float *line, const window *across,
                    const window *along, const int32_t size[4]) {
    int32_t samples = size[0], voxels = size[1], rows = size[2], y = size[3];
    for (int32_t i = 0; i < samples; i++) {
        float sum = 0;
        for (int32_t v = 0; v < across->count; v++)
            sum += across->weight[(int64_t)i * across->count + v] *
                   row[wrapped(across->first[i] + v, voxels)];
        line[i] = sum;
    }
    for (int32_t j = 0; j < samples; j++)
        for (int32_t v = 0; v < along->count; v++) {
            float weight = along->weight[(int64_t)j * along->count + v];
            if (weight == 0 || wrapped(along->first[j] + v, rows) != y)
                continue;
            float *to = sums + (int64_t)samples * j;
            for (int32_t i = 0; i < samples; i++)
                to[i] += weight * line[i];
        }
}

static iso_status resample(float *table, int32_t samples, stack *s, iso_arena *arena) {
    window w[3];
    float *row, *line, *plane;
    int64_t area = (int64_t)samples * samples;
    for (int a = 0; a < 3; a++)
        ISO_TRY(make_window(&w[a], arena, is_distance(s) ? WIDTH_DISTANCE : WIDTH_STEP,
                            (const int32_t[2]){s->size[a], samples}));
    ISO_TRY(ISO_PUSH(row, arena, s->size[0]));
    ISO_TRY(ISO_PUSH(line, arena, samples));
    ISO_TRY(ISO_PUSH(plane, arena, area));
    memset(table, 0, (size_t)(area * samples) * sizeof *table);
    for (int32_t z = 0; z < s->size[2]; z++) {
        memset(plane, 0, (size_t)area * sizeof *plane);
        for (int32_t y = 0; y < s->size[1]; y++) {
            ISO_TRY(read_row(row, s, y, z));
            add_row(plane, row, line, &w[0], &w[1],
                    (const int32_t[4]){samples, s->size[0], s->size[1], y});
        }
        for (int32_t k = 0; k < samples; k++)
            for (int32_t v = 0; v < w[2].count; v++) {
                float weight = w[2].weight[(int64_t)k * w[2].count + v];
                if (weight == 0 || wrapped(w[2].first[k] + v, s->size[2]) != z)
                    continue;
                for (int64_t i = 0; i < area; i++)
                    table[area * k + i] += weight * plane[i];
            }
    }
    return ISO_OK;
}

/* Solid is what is inside of a distance grid, what is above the middle of its values in another
 * grid, and what is lighter than half grey in pictures. */
static void turn_to_field(float *table, int64_t count, const stack *s) {
    float level = s->grey ? 127.5f : 0.5f * (s->least + s->most);
    int as_it_is = is_distance(s);
    for (int64_t i = 0; i < count; i++)
        table[i] = as_it_is ? table[i] : level - table[i];
}

static iso_status fill(iso_lattice_cell *cell, stack *s, const iso_lattice_options *options,
                       iso_arena *arena) {
    ISO_TRY(open_stack(s, options->file));
    int32_t longest = 1, size = SIZE_LEAST;
    for (int a = 0; a < 3; a++)
        longest = s->size[a] > longest ? s->size[a] : longest;
    while (size < 2 * longest && size < SIZE_MOST)
        size *= 2;
    int64_t count = (int64_t)size * size * size;
    for (int a = 0; a < 3; a++)
        cell->size[a] = size;
    ISO_TRY(ISO_ALLOCATE(cell->distance, count));
    ISO_TRY(resample(cell->distance, size, s, arena));
    turn_to_field(cell->distance, count, s);
    double sigma = BLUR_VOXELS * size / longest;
    sigma = sigma < BLUR_SAMPLES ? BLUR_SAMPLES : sigma > 4 ? 4 : sigma;
    if (!is_distance(s))
        ISO_TRY(voxel_blur(cell->distance, size, sigma));
    ISO_TRY(distance_from_field(cell->distance, size, ISO_FIELD_ANY));
    for (int64_t i = 0; i < count; i++)
        cell->distance[i] /= (float)size;
    return ISO_OK;
}

iso_status voxel_file_fill(iso_lattice_cell *cell, const iso_lattice_options *options) {
    stack s = {0};
    iso_arena arena = {0};
    iso_status status = fill(cell, &s, options, &arena);
    iso_arena_free(&arena);
    close_stack(&s);
    return status;
}
