/* Files of multi-links: what goes out comes in again, and no bytes do harm. */
#include "check.h"

#include <stdlib.h>
#include <unistd.h>

#include <isoslice/link.h>

#include "base/memory.h"
#include "link/samples.h"
#include "link/surfaces.h"

static char path[256];

static int says(const char *part) {
    int found = strstr(iso_error_message(), part) != NULL;
    if (!found)
        fprintf(stderr, "  it says: %s\n", iso_error_message());
    return found;
}

static unsigned char *read_bytes(size_t *size) {
    FILE *file = fopen(path, "rb");
    unsigned char *bytes = malloc(1 << 20);
    *size = file ? fread(bytes, 1, 1 << 20, file) : 0;
    if (file)
        fclose(file);
    return bytes;
}

static void write_bytes(const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(bytes, 1, size, file) == size);
    if (file)
        fclose(file);
}

/* The bytes of a sample's file, exactly as many as allocated so that a reader beyond them shows. */
static unsigned char *sample_bytes(size_t *size, int kind, iso_link_number number) {
    iso_multilink link;
    if (!CHECK_OK(make_sample(&link, kind)))
        exit(1);
    CHECK_OK(iso_multilink_write(path, &link, number));
    iso_multilink_free(&link);
    unsigned char *all = read_bytes(size), *bytes = malloc(*size);
    memcpy(bytes, all, *size);
    free(all);
    return bytes;
}

static void check_same(const iso_multilink *x, const iso_multilink *y, int rounded) {
    CHECK(x->kind == y->kind && x->size == y->size && x->dimension == y->dimension);
    CHECK_EQUAL(x->map_count, y->map_count);
    CHECK_EQUAL(x->projection_count, y->projection_count);
    for (int i = 0; i < 2 * ISO_LINK_MAPS_MAX; i++) {
        int is_map = i < ISO_LINK_MAPS_MAX, k = i % ISO_LINK_MAPS_MAX;
        const iso_map *p = is_map ? &x->map[k] : &x->projection[k];
        const iso_map *q = is_map ? &y->map[k] : &y->projection[k];
        CHECK(strcmp(p->name, q->name) == 0);
        CHECK(p->rule == q->rule && p->range == q->range);
        for (int32_t a = 0; p->name[0] && a < x->size; a++)
            CHECK_EQUAL(iso_map_at(p, a), iso_map_at(q, a));
    }
    for (int64_t i = 0; i < (int64_t)x->size * x->dimension; i++)
        CHECK((rounded ? (double)(float)x->g[i] : x->g[i]) == y->g[i]);
}

static void test_every_kind_comes_back(void) {
    for (int kind = 0; kind < SAMPLE_COUNT; kind++)
        for (int number = 4; number <= 8; number += 4) {
            iso_multilink link, back;
            if (!CHECK_OK(make_sample(&link, kind)))
                return;
            CHECK_OK(iso_multilink_write(path, &link, (iso_link_number)number));
            if (CHECK_OK(iso_multilink_read(&back, path)))
                check_same(&link, &back, number == 4);
            CHECK_OK(iso_multilink_validate(&back));
            iso_multilink_free(&link);
            iso_multilink_free(&back);
        }
}

/* More coordinates than a chunk of the writer, an odd number of them, and an odd size. */
static void test_long_float_geometry(void) {
    enum { SIZE = 4097 };
    static int32_t phi[SIZE];
    static double g[SIZE];
    iso_link link;
    iso_multilink back;
    for (int i = 0; i < SIZE; i++) {
        phi[i] = (i + 1) % SIZE;
        g[i] = i / 3.0;
    }
    CHECK_OK(iso_link_new(&link, SIZE, phi, 1, g));
    CHECK_OK(iso_multilink_write(path, &link.link, ISO_LINK_FLOAT32));
    if (CHECK_OK(iso_multilink_read(&back, path)))
        check_same(&link.link, &back, 1);
    iso_multilink_free(&back);
    iso_multilink_free(&link.link);
}

static int32_t int_at(const unsigned char *bytes, size_t at) {
    return (int32_t)((uint32_t)bytes[at] | (uint32_t)bytes[at + 1] << 8 |
                     (uint32_t)bytes[at + 2] << 16 | (uint32_t)bytes[at + 3] << 24);
}

/* The layout that docs/link-file.md promises, byte by byte. */
static void test_layout(void) {
    size_t size;
    unsigned char *bytes = sample_bytes(&size, ISO_KIND_COLOURED_LINK, ISO_LINK_FLOAT64);
    static const int32_t header[8] = {1, 128, 1, 5, 1, 1, 2, 8};
    static const int32_t phi[5] = {1, 2, 0, 4, 3}, colour[5] = {2, 2, 2, 0, 0};
    static const double g[10] = {0, 0, 1, 0, 0, 1, 5, 5.1, 6, 6.25};
    CHECK_EQUAL(128 + 24 + 80 + 24, size);
    CHECK(memcmp(bytes, "ISOLINK\n", 8) == 0);
    for (int i = 0; i < 8; i++)
        CHECK_EQUAL(header[i], int_at(bytes, 8 + 4 * (size_t)i));
    CHECK(memcmp(bytes + 64, "φ\0\0\0\0\0\0\0\0\0\0\0\0\0", 16) == 0);
    CHECK(memcmp(bytes + 96, "c\0", 2) == 0);
    CHECK_EQUAL(5, int_at(bytes, 64 + 28));
    CHECK_EQUAL(3, int_at(bytes, 96 + 28));
    for (int i = 0; i < 5; i++) {
        CHECK_EQUAL(phi[i], int_at(bytes, 128 + 4 * (size_t)i));
        CHECK_EQUAL(colour[i], int_at(bytes, 128 + 24 + 80 + 4 * (size_t)i));
    }
    CHECK(memcmp(bytes + 128 + 24, g, sizeof g) == 0);
    CHECK_EQUAL(0, int_at(bytes, 128 + 20));
    free(bytes);
}

static void test_wrong_lengths(void) {
    for (int kind = 0; kind < SAMPLE_COUNT; kind++) {
        size_t size;
        unsigned char *bytes = sample_bytes(&size, kind, ISO_LINK_FLOAT32);
        iso_multilink link;
        for (size_t length = 0; length < size; length += length < 600 ? 1 : 37) {
            unsigned char *part = malloc(length ? length : 1);
            memcpy(part, bytes, length);
            CHECK_STATUS(ISO_UNREADABLE, iso_multilink_decode(&link, part, length));
            free(part);
        }
        unsigned char *longer = calloc(size + 8, 1);
        memcpy(longer, bytes, size);
        CHECK_STATUS(ISO_UNREADABLE, iso_multilink_decode(&link, longer, size + 1));
        CHECK_STATUS(ISO_UNREADABLE, iso_multilink_decode(&link, longer, size + 8));
        CHECK(says("by its header the file has"));
        CHECK(link.size == 0 && link.owns == 0);
        free(longer);
        free(bytes);
    }
}

static void put_int(unsigned char *bytes, size_t at, int32_t value) {
    for (int k = 0; k < 4; k++)
        bytes[at + (size_t)k] = (unsigned char)((uint32_t)value >> (8 * k));
}

static void test_wrong_headers(void) {
    static const struct {
        size_t at;
        int32_t value;
        const char *message;
    } row[] = {
        {0, 0, "not a multi-link file"},
        {8, 2, "version 2 of the multi-link format"},
        {12, 96, "a header of 96 bytes"},
        {12, -1, "a header of -1 bytes"},
        {16, 9, "no multi-link has kind 9"},
        {16, -1, "no multi-link has kind -1"},
        {16, 5, "no multi-link has kind 5, size 5, 1 maps"},
        {20, -5, "size -5"},
        {20, INT32_MAX, "by its header the file has"},
        {24, 2, "2 maps"},
        {24, -1, "-1 maps"},
        {28, 9, "9 projections"},
        {28, 0, "0 projections"},
        {32, 17, "dimension 17"},
        {32, -2, "dimension -2"},
        {32, 0, "coordinates of 8 bytes in dimension 0"},
        {36, 0, "coordinates of 0 bytes in dimension 2"},
        {36, 16, "coordinates of 16 bytes"},
        {60, 1, "byte 60 of the header is not 0"},
        {64, 0, "column 0 of the header has no proper name"},
        {64, 0x0A41, "column 0 of the header has no proper name"}, /* a line feed */
        {68, 7, "column 0 of the header has no proper name"},
        {80, 4, "φ has rule 4"},
        {92, 6, "the range of φ is 6"},
        {124, 2, "c takes index 0 to 2, outside 0 .. 1"},
        {124, -1, "the range of c is -1"},
        {128, 5, "φ takes index 0 to 5, outside 0 .. 4"},
        {128, -1, "φ takes index 0 to -1"},
    };
    size_t size;
    unsigned char *bytes = sample_bytes(&size, ISO_KIND_COLOURED_LINK, ISO_LINK_FLOAT64);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        iso_multilink link;
        int32_t kept = int_at(bytes, row[i].at);
        put_int(bytes, row[i].at, row[i].value);
        CHECK_STATUS(ISO_UNREADABLE, iso_multilink_decode(&link, bytes, size));
        CHECK(says(row[i].message));
        put_int(bytes, row[i].at, kept);
    }
    free(bytes);
}

/* A lattice of two billion indexes is 96 bytes, and so is a lie about one. */
static void test_implicit_maps_need_no_memory(void) {
    unsigned char bytes[96] = "ISOLINK\n";
    static const int32_t header[8] = {1, 96, 0, INT32_MAX, 1, 0, 0, 0};
    iso_multilink link;
    for (int i = 0; i < 8; i++)
        put_int(bytes, 8 + 4 * (size_t)i, header[i]);
    bytes[64] = 'x';
    put_int(bytes, 80, ISO_MAP_CLAMPED);
    put_int(bytes, 84, 1);
    put_int(bytes, 88, INT32_MAX);
    put_int(bytes, 92, INT32_MAX);
    CHECK_OK(iso_multilink_decode(&link, bytes, sizeof bytes));
    CHECK_EQUAL(INT32_MAX, link.size);
    CHECK_EQUAL(INT32_MAX - 1, iso_map_at(&link.map[0], INT32_MAX - 1));
    iso_multilink_free(&link);
    put_int(bytes, 84, 2);
    CHECK_STATUS(ISO_UNREADABLE, iso_multilink_decode(&link, bytes, sizeof bytes));
    put_int(bytes, 84, 0);
    CHECK_STATUS(ISO_UNREADABLE, iso_multilink_decode(&link, bytes, sizeof bytes));
}

/* Follow every map everywhere: what the reader accepts is safe to use. */
static int64_t use(const iso_multilink *link) {
    int64_t sum = 0;
    int32_t most = link->size < 4096 ? link->size : 4096;
    for (int i = 0; i < link->map_count; i++)
        for (int32_t a = 0; a < most; a++)
            sum += iso_map_at(&link->map[i], iso_map_at(&link->map[i], a));
    for (int i = 0; i < link->projection_count; i++)
        for (int32_t a = 0; a < most; a++)
            sum += iso_map_at(&link->projection[i], a);
    for (int64_t i = 0; i < (int64_t)most * link->dimension; i++)
        sum += link->g[i] > 0;
    return sum;
}

static void test_mutated_bytes(void) {
    uint64_t state = 2;
    int accepted = 0, refused = 0, valid = 0;
    for (int kind = 0; kind < SAMPLE_COUNT; kind++) {
        size_t size;
        unsigned char *bytes = sample_bytes(&size, kind, ISO_LINK_FLOAT64);
        unsigned char *changed = malloc(size);
        for (int turn = 0; turn < 4000; turn++) {
            memcpy(changed, bytes, size);
            for (int n = 1 + (int)(next_random(&state) % 3); n > 0; n--) {
                /* half of the changes in the header, where they mean most */
                size_t within = next_random(&state) % 2 ? size : 64 + 32;
                size_t at = next_random(&state) % within;
                changed[at] = next_random(&state) % 2 ? (unsigned char)next_random(&state)
                                                      : changed[at] ^ 1u << next_random(&state) % 8;
            }
            iso_multilink link;
            iso_status status = iso_multilink_decode(&link, changed, size);
            if (status == ISO_OK) {
                accepted++;
                CHECK(use(&link) >= 0);
                if (link.size < 4096)
                    valid += iso_multilink_validate(&link) == ISO_OK;
                iso_multilink_free(&link);
            } else {
                refused++;
                CHECK_EQUAL(ISO_UNREADABLE, status);
                CHECK(link.owns == 0 && link.map[0].image == NULL);
            }
        }
        free(changed);
        free(bytes);
    }
    printf("     %d accepted (%d of them valid), %d refused\n", accepted, valid, refused);
    CHECK(accepted > 1000 && refused > 1000);
}

static void test_nothing_at_all(void) {
    for (int kind = 0; kind < ISO_KIND_COUNT; kind++) {
        iso_multilink view = iso_multilink_view((iso_link_kind)kind, 0, 2, 3, NULL), link, back;
        CHECK_OK(iso_multilink_copy(&link, &view));
        for (int number = 4; number <= 8; number += 4) {
            CHECK_OK(iso_multilink_write(path, &view, (iso_link_number)number));
            CHECK_OK(iso_multilink_read(&back, path));
            check_same(&link, &back, 0);
            iso_multilink_free(&back);
        }
        iso_multilink_free(&link);
    }
}

static void test_paths_that_fail(void) {
    iso_multilink link, back;
    if (!CHECK_OK(make_sample(&link, ISO_KIND_LINK)))
        return;
    CHECK_STATUS(ISO_NOT_WRITTEN,
                 iso_multilink_write("/nowhere/at/all.mlk", &link, ISO_LINK_FLOAT64));
    CHECK_STATUS(ISO_USAGE, iso_multilink_write(path, &link, (iso_link_number)2));
    CHECK_STATUS(ISO_UNREADABLE, iso_multilink_read(&back, "/nowhere/at/all.mlk"));
    CHECK(says("/nowhere/at/all.mlk: can't be opened"));
    CHECK_STATUS(ISO_UNREADABLE, iso_multilink_read(&back, "/"));
    write_bytes("solid", 5);
    CHECK_STATUS(ISO_UNREADABLE, iso_multilink_read(&back, path));
    CHECK(says(path) && says("5 bytes are too few"));
    link.map_count = 0;
    CHECK_STATUS(ISO_USAGE, iso_multilink_write(path, &link, ISO_LINK_FLOAT64));
    link.map_count = 1;
    iso_multilink_free(&link);
}

static void test_memory_that_runs_out(void) {
    size_t size;
    unsigned char *bytes = sample_bytes(&size, ISO_KIND_COUNT, ISO_LINK_FLOAT32);
    iso_status status = ISO_NO_MEMORY;
    for (int n = 0; n < 20 && status == ISO_NO_MEMORY; n++) {
        iso_multilink link = {0}, again = {0};
        iso_fail_allocation_after(n);
        status = iso_multilink_read(&link, path);
        if (status == ISO_OK)
            status = iso_multilink_write(path, &link, ISO_LINK_FLOAT32);
        if (status == ISO_OK)
            status = iso_multilink_decode(&again, bytes, size);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        iso_multilink_free(&link);
        iso_multilink_free(&again);
    }
    CHECK_EQUAL(ISO_OK, status);
    free(bytes);
}

int main(void) {
    snprintf(path, sizeof path, "/tmp/isoslice-link-%ld.mlk", (long)getpid());
    RUN(test_every_kind_comes_back);
    RUN(test_long_float_geometry);
    RUN(test_layout);
    RUN(test_wrong_lengths);
    RUN(test_wrong_headers);
    RUN(test_implicit_maps_need_no_memory);
    RUN(test_mutated_bytes);
    RUN(test_nothing_at_all);
    RUN(test_paths_that_fail);
    RUN(test_memory_that_runs_out);
    remove(path);
    return check_verdict();
}
