/* Grids built from a callback, sampled, written, read and meshed. */
#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "check.h"
#include "solid/volume.h"

static char folder[] = "/tmp/isoslice-volume-XXXXXX";

static const char *file(const char *name) {
    static char path[4][200];
    static int next;
    char *out = path[next++ & 3];
    snprintf(out, sizeof path[0], "%s/%s", folder, name);
    return out;
}

typedef struct ball {
    iso_vec3 middle;
    double radius, voxel;
    int64_t calls;
} ball;

static double ball_distance(const ball *b, iso_vec3 p) {
    double x = p.x - b->middle.x, y = p.y - b->middle.y, z = p.z - b->middle.z;
    return sqrt(x * x + y * y + z * z) - b->radius;
}

static iso_status fill_ball(void *payload, float *value, iso_vec3 corner) {
    ball *b = payload;
    b->calls++;
    for (int i = 0; i < 512; i++) {
        iso_vec3 p = {corner.x + b->voxel * (i % 8), corner.y + b->voxel * (i / 8 % 8),
                      corner.z + b->voxel * (i / 64)};
        value[i] = (float)ball_distance(b, p);
    }
    return ISO_OK;
}

static iso_status fill_never(void *payload, float *value, iso_vec3 corner) {
    return iso_fail(ISO_UNSLICEABLE, "the callback's own reason");
}

static iso_volume_plan plan_ball(ball *b, iso_volume_kind kind) {
    double r = b->radius + 1;
    return (iso_volume_plan){.min = {b->middle.x - r, b->middle.y - r, b->middle.z - r},
                             .max = {b->middle.x + r, b->middle.y + r, b->middle.z + r},
                             .voxel = b->voxel,
                             .kind = kind,
                             .name = "ball",
                             .fill = fill_ball,
                             .payload = b};
}

/* Volume, and what makes a closed surface: each edge twice, in both senses. */
typedef struct edge {
    float end[6];
} edge;

static int compare_edges(const void *a, const void *b) {
    return memcmp(a, b, sizeof(edge));
}

static int compare_points(const void *a, const void *b) {
    return memcmp(a, b, 3 * sizeof(float));
}

typedef struct surface_facts {
    double volume, area;
    int64_t corners, edges, faces;
    int closed;
} surface_facts;

static surface_facts look_at(float *t, int64_t count) {
    surface_facts facts = {.faces = count, .closed = 1};
    edge *edges = malloc((size_t)count * 3 * sizeof *edges);
    edge *turned = malloc((size_t)count * 3 * sizeof *turned);
    for (int64_t i = 0; i < 9 * count; i++)
        t[i] += 0.0f; /* -0 and 0 are one place */
    for (int64_t i = 0; i < count; i++) {
        const float *a = t + 9 * i, *b = a + 3, *c = a + 6;
        facts.volume += (a[0] * ((double)b[1] * c[2] - (double)b[2] * c[1]) +
                         a[1] * ((double)b[2] * c[0] - (double)b[0] * c[2]) +
                         a[2] * ((double)b[0] * c[1] - (double)b[1] * c[0])) /
                        6;
        for (int k = 0; k < 3; k++) {
            memcpy(edges[3 * i + k].end, a + 3 * k, 12);
            memcpy(edges[3 * i + k].end + 3, a + 3 * ((k + 1) % 3), 12);
            memcpy(turned[3 * i + k].end, a + 3 * ((k + 1) % 3), 12);
            memcpy(turned[3 * i + k].end + 3, a + 3 * k, 12);
        }
    }
    qsort(edges, (size_t)count * 3, sizeof *edges, compare_edges);
    qsort(turned, (size_t)count * 3, sizeof *turned, compare_edges);
    facts.closed = memcmp(edges, turned, (size_t)count * 3 * sizeof *edges) == 0;
    facts.edges = 3 * count / 2;
    float *points = malloc((size_t)count * 9 * sizeof *points);
    memcpy(points, t, (size_t)count * 9 * sizeof *points);
    qsort(points, (size_t)count * 3, 12, compare_points);
    for (int64_t i = 0; i < 3 * count; i++)
        facts.corners += i == 0 || memcmp(points + 3 * i, points + 3 * i - 3, 12) != 0;
    free(points);
    free(edges);
    free(turned);
    return facts;
}

static void test_ball_as_distance(void) {
    ball b = {.middle = {1.3, -20.7, 5.2}, .radius = 6, .voxel = 0.25};
    iso_volume_plan plan = plan_ball(&b, ISO_VOLUME_DISTANCE);
    iso_volume *volume;
    if (!CHECK_OK(volume_build(&volume, &plan)))
        return;
    iso_volume_info info;
    volume_info(&info, volume);
    CHECK_NEAR(0.25, info.voxel, 1e-15);
    CHECK_NEAR(0.75, info.background, 1e-7);
    CHECK_EQUAL(1, info.is_distance);
    CHECK_NEAR(1.3 - 6, info.min.x, 1);
    CHECK_NEAR(5.2 + 6, info.max.z, 1);
    /* the band's volume, 4 pi r^2 x 6 voxels and a little for its curvature */
    CHECK_NEAR(4 * 3.14159265 * (36 * 1.5 + 2 * 0.75 * 0.75 * 0.75 / 3) / (0.25 * 0.25 * 0.25),
               (double)info.active, 600);
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        iso_vec3 p = {1.3 - 8 + 16.0 * (i % 27) / 26, -20.7 - 8 + 16.0 * (i / 27 % 27) / 26,
                      5.2 - 8 + 16.0 * (i / 729) / 27};
        double value, truth = ball_distance(&b, p);
        CHECK_OK(volume_sample(&value, volume, &p, 1));
        if (fabs(truth) < 0.25)
            worst = fabs(truth - value) > worst ? fabs(truth - value) : worst;
        else
            CHECK(truth < 0 ? value < 0 : value > 0);
    }
    CHECK_NEAR(0, worst, 0.25 * 0.25 / 6); /* h^2 / (2 r) from curvature, in 3 directions */
    float *t;
    int64_t count;
    CHECK_OK(volume_surface(&t, &count, volume, 0));
    surface_facts facts = look_at(t, count);
    CHECK(facts.closed);
    CHECK_EQUAL(2, facts.corners - facts.edges + facts.faces);
    CHECK_NEAR(1, facts.volume / (4.0 / 3 * 3.14159265358979 * 216), 0.005);
    float *again;
    int64_t again_count;
    CHECK_OK(volume_surface(&again, &again_count, volume, 0));
    CHECK(CHECK_EQUAL(count, again_count) && memcmp(t, again, (size_t)count * 36) == 0);
    iso_release(again);
    iso_release(t);
    CHECK_OK(volume_surface(&t, &count, volume, 0.5));
    facts = look_at(t, count);
    CHECK_NEAR(1, facts.volume / (4.0 / 3 * 3.14159265358979 * 6.5 * 6.5 * 6.5), 0.005);
    iso_release(t);
    volume_free(volume);
}

int main(void) {
    if (!mkdtemp(folder))
        return 1;
    RUN(test_ball_as_distance);
    (void)file;
    (void)fill_never;
    return check_verdict();
}
