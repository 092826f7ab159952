#include "floors.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "measure.h"
#include "planar/section.h"

enum { CHUNK = 1 << 17 };

typedef struct transfer {
    const char *path;
    char *buffer;
    int64_t bytes;
} transfer;

static void read_all(void *payload) {
    const transfer *t = payload;
    int file = open(t->path, O_RDONLY | O_CLOEXEC);
    bench_must_system(file >= 0, t->path);
    ssize_t got;
    while ((got = read(file, t->buffer, CHUNK)) > 0)
        continue;
    bench_must_system(got == 0, t->path);
    close(file);
}

static void write_all(void *payload) {
    const transfer *t = payload;
    int file = open(t->path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    bench_must_system(file >= 0, t->path);
    for (int64_t left = t->bytes; left > 0;) {
        ssize_t n = write(file, t->buffer, (size_t)(left < CHUNK ? left : CHUNK));
        bench_must_system(n > 0, t->path);
        left -= n;
    }
    close(file);
}

static void remove_file(void *payload) {
    unlink(((const transfer *)payload)->path);
}

double floor_read(const char *path) {
    transfer t = {path, bench_allocate(CHUNK), 0};
    double least = bench_least(read_all, NULL, &t);
    free(t.buffer);
    return least;
}

double floor_write(const char *path, int64_t bytes) {
    transfer t = {path, bench_allocate(CHUNK), bytes};
    memset(t.buffer, ' ', CHUNK);
    double least = bench_least(write_all, remove_file, &t);
    free(t.buffer);
    return least;
}

typedef struct copying {
    char *from, *to;
    size_t size;
} copying;

static void copy(void *payload) {
    const copying *c = payload;
    memcpy(c->to, c->from, c->size);
    __asm__ volatile("" : : "r"(c->to) : "memory"); /* somebody may look at it */
}

double floor_copy(int64_t bytes) {
    copying c = {bench_allocate(bytes / 2), bench_allocate(bytes / 2), (size_t)(bytes / 2)};
    memset(c.from, 1, c.size);
    memset(c.to, 2, c.size);
    double least = bench_least(copy, NULL, &c);
    free(c.from);
    free(c.to);
    return least;
}

/* ---- slicing ---- */

typedef struct slicing {
    const iso_mesh *mesh;
    const iso_levels *levels;
    int32_t *lowest; /* [vertex] first level at or above it */
    int32_t *place;  /* [dart] its crossing with level i is number place + i */
    int32_t *successor;
    iso_vec2 *point;
    int64_t count;
} slicing;

static void find_lowest(slicing *s) {
    const double *cut = s->levels->cut;
    int32_t count = s->levels->count;
    double scale = count > 1 ? (count - 1) / (cut[count - 1] - cut[0]) : 0;
    for (int32_t v = 0; v < s->mesh->vertex_count; v++) {
        double z = s->mesh->position[v].z, guess = (z - cut[0]) * scale;
        int32_t i = guess <= 0 ? 0 : guess >= count ? count : (int32_t)guess;
        while (i > 0 && cut[i - 1] >= z)
            i--;
        while (i < count && cut[i] < z)
            i++;
        s->lowest[v] = i;
    }
}

static void find_places(slicing *s) {
    const int32_t *origin = s->mesh->origin, *lowest = s->lowest;
    int32_t darts = 3 * s->mesh->triangle_count, at = 0;
    for (int32_t a = 0; a < darts; a++) {
        int32_t from = lowest[origin[a]], to = lowest[origin[iso_mesh_alpha(a)]];
        s->place[a] = at - from;
        at += to > from ? to - from : 0;
    }
    s->count = at;
}

static void find_crossings(slicing *s) {
    const int32_t *origin = s->mesh->origin, *opposite = s->mesh->opposite, *lowest = s->lowest;
    const iso_vec3 *position = s->mesh->position;
    const double *cut = s->levels->cut;
    int32_t darts = 3 * s->mesh->triangle_count;
    for (int32_t a = 0; a < darts; a++) {
        int32_t low = origin[a], high = origin[iso_mesh_alpha(a)];
        int32_t begin = lowest[low], end = lowest[high];
        if (begin >= end)
            continue;
        int32_t above = iso_mesh_alpha(opposite[a]), below = iso_mesh_alpha(above);
        int32_t apex = lowest[origin[below]];
        iso_vec3 p = position[low], q = position[high];
        for (int32_t i = begin; i < end; i++) {
            int32_t here = s->place[a] + i;
            double t = (cut[i] - p.z) / (q.z - p.z);
            s->successor[here] = s->place[apex > i ? above : below] + i;
            s->point[here] = (iso_vec2){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
        }
    }
}

static void slice(void *payload) {
    slicing *s = payload;
    s->lowest = bench_allocate(s->mesh->vertex_count * (int64_t)sizeof *s->lowest);
    s->place = bench_allocate(3 * (int64_t)s->mesh->triangle_count * (int64_t)sizeof *s->place);
    find_lowest(s);
    find_places(s);
    s->successor = bench_allocate(s->count * (int64_t)sizeof *s->successor);
    s->point = bench_allocate(s->count * (int64_t)sizeof *s->point);
    find_crossings(s);
}

static void forget(void *payload) {
    slicing *s = payload;
    free(s->lowest);
    free(s->place);
    free(s->successor);
    free(s->point);
}

/* A floor that finds something else is none. */
static int agrees(const slicing *s, const iso_slices *slices) {
    double found = 0, expected = 0;
    if (s->count != slices->crossing_count)
        return 0;
    for (int64_t q = 0; q < s->count; q++) {
        iso_vec2 a = s->point[q], b = s->point[s->successor[q]];
        found += (a.x * b.y - b.x * a.y) / 2;
    }
    for (int32_t i = 0; i < slices->level_count; i++)
        expected += section_area(slices, i);
    return fabs(found - expected) <= 1e-6 * fabs(expected);
}

double floor_slice(const iso_mesh *mesh, const iso_levels *levels, const iso_slices *slices) {
    slicing s = {.mesh = mesh, .levels = levels};
    double least = bench_least(slice, forget, &s);
    slice(&s);
    if (!agrees(&s, slices)) {
        fprintf(stderr, "bench-stages: the floor's slices are not the engine's\n");
        exit(1);
    }
    forget(&s);
    return least;
}
