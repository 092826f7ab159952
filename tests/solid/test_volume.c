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
    double volume;
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

static iso_status fill_everything(void *payload, float *value, iso_vec3 corner) {
    for (int i = 0; i < 512; i++)
        value[i] = -100;
    return ISO_OK;
}

/* The voxels of a mask are counted one by one. */
static void test_ball_as_mask(void) {
    ball b = {.middle = {100, 3, -7}, .radius = 5, .voxel = 0.2};
    iso_volume_plan plan = plan_ball(&b, ISO_VOLUME_SOLID);
    iso_volume *volume;
    if (!CHECK_OK(volume_build(&volume, &plan)))
        return;
    int64_t expected = 0;
    for (int z = 0; z <= 60; z++)
        for (int y = 0; y <= 60; y++)
            for (int x = 0; x <= 60; x++) {
                int64_t dx = x - 30, dy = y - 30, dz = z - 30;
                /* 25^2: those on the sphere exactly may fall on either side */
                expected += dx * dx + dy * dy + dz * dz < 625;
            }
    iso_volume_info info;
    volume_info(&info, volume);
    CHECK(info.active >= expected && info.active <= expected + 1000);
    CHECK_EQUAL(0, info.is_distance);
    CHECK_NEAR(0, info.background, 0);
    iso_vec3 point[3] = {b.middle, {90, 3, -7}, {1e300, NAN, 0}};
    double value[3];
    CHECK_OK(volume_sample(value, volume, point, 3));
    CHECK_NEAR(1, value[0], 0);
    CHECK_NEAR(0, value[1], 0);
    CHECK_NEAR(0, value[2], 0);
    float *t;
    int64_t count;
    CHECK_OK(volume_surface(&t, &count, volume, 123));
    surface_facts facts = look_at(t, count);
    CHECK(facts.closed);
    CHECK_NEAR(1, facts.volume / (4.0 / 3 * 3.14159265358979 * 125), 0.02);
    iso_release(t);
    volume_free(volume);
}

/* What a callback gives beyond the box is cut off, and what is full costs next to nothing. */
static void test_box_cuts(void) {
    for (int kind = 0; kind < 2; kind++) {
        iso_volume_plan plan = {.min = {-3, 2, 1},
                                .max = {17, 12, 8.5},
                                .voxel = 0.25,
                                .kind = kind == 0 ? ISO_VOLUME_SOLID : ISO_VOLUME_DISTANCE,
                                .name = "box",
                                .fill = fill_everything};
        iso_volume *volume;
        if (!CHECK_OK(volume_build(&volume, &plan)))
            return;
        iso_volume_info info;
        volume_info(&info, volume);
        if (kind == 0) {
            CHECK_EQUAL(81 * 41 * 31, info.active);
            CHECK_NEAR(-3, info.min.x, 1e-12);
            CHECK_NEAR(8.5, info.max.z, 1e-12);
            CHECK(info.bytes < 600000); /* its bits alone would be 13,000; a root's child is more */
        }
        /* a face where a block begins counts in the block before, too */
        for (int k = 0; k < 4 && kind == 1; k++) {
            const iso_vec3 at = {17 - 0.25 * k, 7, 4.75};
            double distance;
            CHECK_OK(volume_sample(&distance, volume, &at, 1));
            CHECK_NEAR(-0.25 * k, distance, 1e-6);
        }
        float *t;
        int64_t count;
        CHECK_OK(volume_surface(&t, &count, volume, 0));
        surface_facts facts = look_at(t, count);
        CHECK(facts.closed);
        /* a mask's surface lies half a voxel beyond the middles of its last ones */
        double truth = kind == 0 ? 20.25 * 10.25 * 7.75 : 20 * 10 * 7.5;
        CHECK_NEAR(1, facts.volume / truth, 0.005);
        iso_release(t);
        volume_free(volume);
    }
}

static void test_bad_plans(void) {
    ball b = {.radius = 2, .voxel = 0.5};
    iso_volume_plan plan = plan_ball(&b, ISO_VOLUME_SOLID);
    iso_volume *volume;
    plan.voxel = 0;
    CHECK_STATUS(ISO_BAD_CONFIG, volume_build(&volume, &plan));
    CHECK(volume == NULL);
    plan.voxel = NAN;
    CHECK_STATUS(ISO_BAD_CONFIG, volume_build(&volume, &plan));
    plan.voxel = 1e-6;
    CHECK_STATUS(ISO_BAD_CONFIG, volume_build(&volume, &plan));
    CHECK(strstr(iso_error_message(), "take larger ones"));
    plan.voxel = 1e-9;
    CHECK_STATUS(ISO_BAD_CONFIG, volume_build(&volume, &plan));
    plan.voxel = 0.5;
    plan.max.y = plan.min.y - 1;
    CHECK_STATUS(ISO_BAD_CONFIG, volume_build(&volume, &plan));
    plan = plan_ball(&b, ISO_VOLUME_DISTANCE);
    plan.fill = fill_never;
    CHECK_STATUS(ISO_UNSLICEABLE, volume_build(&volume, &plan));
    CHECK(strstr(iso_error_message(), "own reason"));
    CHECK(volume == NULL);
}

static unsigned char *load(const char *path, long *size) {
    FILE *f = fopen(path, "rb");
    if (!f)
        return NULL;
    fseek(f, 0, SEEK_END);
    *size = ftell(f);
    fseek(f, 0, SEEK_SET);
    unsigned char *bytes = malloc((size_t)*size + 1);
    if (fread(bytes, 1, (size_t)*size, f) != (size_t)*size)
        *size = 0;
    fclose(f);
    return bytes;
}

static void store(const char *path, const void *bytes, size_t size) {
    FILE *f = fopen(path, "wb");
    fwrite(bytes, 1, size, f);
    fclose(f);
}

static void test_there_and_back(void) {
    for (int kind = 0; kind < 2; kind++) {
        ball b = {.middle = {4, 5, 60}, .radius = 3, .voxel = 0.25};
        iso_volume_plan plan = plan_ball(&b, kind == 0 ? ISO_VOLUME_DISTANCE : ISO_VOLUME_SOLID);
        iso_volume *volume, *back, *again;
        if (!CHECK_OK(volume_build(&volume, &plan)))
            return;
        CHECK_OK(volume_write(volume, file("one.vdb")));
        CHECK_OK(volume_build(&again, &plan));
        CHECK_OK(volume_write(again, file("two.vdb")));
        volume_free(again);
        CHECK_OK(volume_read(&back, file("one.vdb"), "ball"));
        CHECK_OK(volume_write(back, file("three.vdb")));
        long size[3] = {0};
        unsigned char *bytes[3] = {load(file("one.vdb"), &size[0]), load(file("two.vdb"), &size[1]),
                                   load(file("three.vdb"), &size[2])};
        CHECK(size[0] == size[1] && memcmp(bytes[0], bytes[1], (size_t)size[0]) == 0);
        CHECK(size[0] > 1000 && size[2] > 1000);
        for (int i = 0; i < 3; i++)
            free(bytes[i]);
        iso_volume_info was, is;
        volume_info(&was, volume);
        volume_info(&is, back);
        CHECK_EQUAL(was.active, is.active);
        CHECK_EQUAL(was.is_distance, is.is_distance);
        CHECK_NEAR(was.voxel, is.voxel, 0);
        CHECK_NEAR(was.min.x, is.min.x, 0);
        CHECK_NEAR(was.max.z, is.max.z, 0);
        for (int i = 0; i < 1000; i++) {
            iso_vec3 p = {0.8 * (i % 10), 1 + 0.8 * (i / 10 % 10), 56 + 0.8 * (i / 100)};
            double a, c;
            CHECK_OK(volume_sample(&a, volume, &p, 1));
            CHECK_OK(volume_sample(&c, back, &p, 1));
            CHECK(a == c);
        }
        volume_free(back);
        CHECK_OK(volume_read(&back, file("one.vdb"), NULL));
        volume_free(back);
        CHECK_STATUS(ISO_UNREADABLE, volume_read(&back, file("one.vdb"), "density"));
        CHECK(strstr(iso_error_message(), "\"ball\"") != NULL);
        CHECK(back == NULL);
        CHECK_STATUS(ISO_NOT_WRITTEN, volume_write(volume, "/nowhere/at/all.vdb"));
        volume_free(volume);
    }
    iso_volume *volume;
    CHECK_STATUS(ISO_UNREADABLE, volume_read(&volume, file("missing.vdb"), NULL));
    CHECK(strstr(iso_error_message(), "missing.vdb") != NULL);
    CHECK_STATUS(ISO_UNREADABLE, volume_read(&volume, folder, NULL));
    store(file("text.vdb"), "solid cube\n", 11);
    CHECK_STATUS(ISO_UNREADABLE, volume_read(&volume, file("text.vdb"), NULL));
    store(file("empty.vdb"), "", 0);
    CHECK_STATUS(ISO_UNREADABLE, volume_read(&volume, file("empty.vdb"), NULL));
}

static uint64_t seed = 88172645463325252u;

static uint64_t next_random(void) {
    seed ^= seed << 13;
    seed ^= seed >> 7;
    return seed ^= seed << 17;
}

/* OpenVDB 10 itself forgets the part of a tree that it was at when reading throws: some 270 KB for
 * a damaged file. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:readTopology\n";
}

/* Cut off and flipped: any status, never a crash. What can be read can be used. */
static void test_damaged_files(void) {
    static int failed, read;
    for (int kind = 0; kind < 2; kind++) {
        ball b = {.middle = {4, 5, 6}, .radius = 3, .voxel = 0.5};
        iso_volume_plan plan = plan_ball(&b, kind == 0 ? ISO_VOLUME_DISTANCE : ISO_VOLUME_SOLID);
        iso_volume *volume;
        if (!CHECK_OK(volume_build(&volume, &plan)))
            return;
        CHECK_OK(volume_write(volume, file("sound.vdb")));
        volume_free(volume);
        long size = 0;
        unsigned char *bytes = load(file("sound.vdb"), &size);
        unsigned char *bad = malloc((size_t)size);
        const char *path = file("bad.vdb");
        for (int i = 0; i < 60; i++) {
            store(path, bytes, (size_t)(i * (size - 1) / 59));
            CHECK_STATUS(ISO_UNREADABLE, volume_read(&volume, path, NULL));
        }
        for (int i = 0; i < 1200; i++) {
            memcpy(bad, bytes, (size_t)size);
            int flips = 1 + (int)(next_random() % 4);
            for (int k = 0; k < flips; k++) {
                /* heads more often than voxels */
                long range = i % 2 == 0 ? (size < 1000 ? size : 1000) : size;
                bad[next_random() % (uint64_t)range] ^= (unsigned char)(1 << next_random() % 8);
            }
            store(path, bad, (size_t)size);
            iso_status status = volume_read(&volume, path, NULL);
            if (status != ISO_OK) {
                failed++;
                CHECK(status == ISO_UNREADABLE || status == ISO_NO_MEMORY);
                CHECK(volume == NULL);
                continue;
            }
            read++;
            double value;
            CHECK_OK(volume_sample(&value, volume, &b.middle, 1));
            volume_free(volume);
        }
        free(bad);
        free(bytes);
    }
    CHECK(failed > 100 && read > 100);
}

static void test_out_of_memory(void) {
    ball b = {.middle = {4, 5, 6}, .radius = 2, .voxel = 0.5};
    iso_volume_plan plan = plan_ball(&b, ISO_VOLUME_DISTANCE);
    for (int64_t n = 0; n < 20; n++) {
        iso_volume *volume;
        float *t;
        int64_t count;
        iso_fail_allocation_after(n);
        iso_status status = volume_build(&volume, &plan);
        if (status != ISO_OK) {
            iso_fail_allocation_after(-1);
            CHECK_EQUAL(ISO_NO_MEMORY, status);
            CHECK(volume == NULL);
            continue;
        }
        status = volume_surface(&t, &count, volume, 0);
        if (status == ISO_OK)
            iso_release(t);
        iso_status written = volume_write(volume, file("memory.vdb"));
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        CHECK(written == ISO_OK || written == ISO_NO_MEMORY);
        volume_free(volume);
    }
}

static void remove_folder(void) {
    static const char *const names[] = {"one.vdb", "two.vdb",   "three.vdb", "text.vdb",
                                        "bad.vdb", "empty.vdb", "sound.vdb", "memory.vdb"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        unlink(file(names[i]));
    CHECK(rmdir(folder) == 0); /* and no half-written file in it */
}

int main(void) {
    if (!mkdtemp(folder))
        return 1;
    RUN(test_ball_as_distance);
    RUN(test_ball_as_mask);
    RUN(test_box_cuts);
    RUN(test_bad_plans);
    RUN(test_there_and_back);
    RUN(test_damaged_files);
    RUN(test_out_of_memory);
    remove_folder();
    return check_verdict();
}
