/* Stacks of PNG pictures. They are made here byte by byte: chunks with checksums, and rows stored
 * without compression, so that no other library has a say. */
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "check.h"
#include "solid/volume.h"

static char folder[] = "/tmp/isoslice-pictures-XXXXXX";

static const char *file(const char *name) {
    static char path[8][200];
    static int next;
    char *out = path[next++ & 7];
    snprintf(out, sizeof path[0], "%s/%s", folder, name);
    return out;
}

typedef struct bytes {
    unsigned char data[8192];
    size_t size;
} bytes;

static void put(bytes *b, const void *data, size_t size) {
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

static void put_big(bytes *b, uint32_t value) {
    unsigned char big[4] = {(unsigned char)(value >> 24), (unsigned char)(value >> 16),
                            (unsigned char)(value >> 8), (unsigned char)value};
    put(b, big, 4);
}

static void put_chunk(bytes *out, const char *type, const bytes *content) {
    put_big(out, (uint32_t)content->size);
    size_t start = out->size;
    put(out, type, 4);
    put(out, content->data, content->size);
    uint32_t sum = 0xffffffffu;
    for (size_t i = start; i < out->size; i++) {
        sum ^= out->data[i];
        for (int bit = 0; bit < 8; bit++)
            sum = sum & 1 ? 0xedb88320u ^ (sum >> 1) : sum >> 1;
    }
    put_big(out, sum ^ 0xffffffffu);
}

enum { GREY = 0, COLOUR = 2, PALETTE = 3, GREY_ALPHA = 4 };

/* rows: [height] rows of `row` bytes */
static void make_png(bytes *out, int width, int height, int depth, int colour,
                     const unsigned char *rows, size_t row) {
    static const unsigned char head[8] = {137, 'P', 'N', 'G', 13, 10, 26, 10};
    out->size = 0;
    put(out, head, 8);
    bytes chunk = {.size = 0};
    put_big(&chunk, (uint32_t)width);
    put_big(&chunk, (uint32_t)height);
    unsigned char kind[5] = {(unsigned char)depth, (unsigned char)colour, 0, 0, 0};
    put(&chunk, kind, 5);
    put_chunk(out, "IHDR", &chunk);
    if (colour == PALETTE) {
        chunk.size = 0;
        put(&chunk, "\x00\x00\x00\x40\x40\x40\x80\x80\x80\xff\xff\xff", 12);
        put_chunk(out, "PLTE", &chunk);
    }
    /* zlib: one stored block, then Adler's sum */
    bytes raw = {.size = 0};
    for (int y = 0; y < height; y++) {
        put(&raw, "", 1);
        put(&raw, rows + (size_t)y * row, row);
    }
    chunk.size = 0;
    unsigned char stored[7] = {0x78,
                               1,
                               1,
                               (unsigned char)raw.size,
                               (unsigned char)(raw.size >> 8),
                               (unsigned char)~raw.size,
                               (unsigned char)(~raw.size >> 8)};
    put(&chunk, stored, 7);
    put(&chunk, raw.data, raw.size);
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < raw.size; i++) {
        a = (a + raw.data[i]) % 65521;
        b = (b + a) % 65521;
    }
    put_big(&chunk, b << 16 | a);
    put_chunk(out, "IDAT", &chunk);
    chunk.size = 0;
    put_chunk(out, "IEND", &chunk);
}

static void store(const char *path, const void *data, size_t size) {
    FILE *f = fopen(path, "wb");
    fwrite(data, 1, size, f);
    fclose(f);
}

static void store_grey(const char *name, int width, int height, int first) {
    unsigned char rows[64];
    for (int i = 0; i < width * height; i++)
        rows[i] = (unsigned char)(first + i);
    bytes png;
    make_png(&png, width, height, 8, GREY, rows, (size_t)width);
    store(file(name), png.data, png.size);
}

static void forget(const char *name) {
    unlink(file(name));
}

static void test_stack(void) {
    for (int start = 0; start < 2; start++) {
        char name[3][32];
        for (int i = 0; i < 3; i++) {
            snprintf(name[i], sizeof name[i], "layer%03d.png", start + i);
            store_grey(name[i], 4, 3, 20 * i);
        }
        for (int way = 0; way < 2; way++) {
            uint8_t *value;
            int32_t size[3];
            if (!CHECK_OK(
                    volume_read_pictures(&value, size, way == 0 ? file("layer%03d.png") : folder)))
                continue;
            CHECK(size[0] == 4 && size[1] == 3 && size[2] == 3);
            for (int z = 0; z < 3; z++)
                for (int y = 0; y < 3; y++)
                    for (int x = 0; x < 4; x++) /* the last row lies at y = 0 */
                        CHECK_EQUAL(20 * z + 4 * (2 - y) + x, value[x + 4 * (y + 3 * z)]);
            iso_release(value);
        }
        for (int i = 0; i < 3; i++)
            forget(name[i]);
    }
}

static void test_kinds(void) {
    static const struct {
        int depth, colour;
        size_t row;
        unsigned char rows[32];
        unsigned char expected[4]; /* 2 x 2, the lower row first */
    } kind[] = {
        {8, GREY, 2, {0, 255, 17, 200}, {17, 200, 0, 255}},
        {16, GREY, 4, {0, 0, 255, 255, 17, 17, 200, 200}, {17, 200, 0, 255}},
        {1, GREY, 1, {0x40, 0x80}, {255, 0, 0, 255}},
        {4, GREY, 1, {0x0f, 0x12}, {17, 34, 0, 255}},
        {2, PALETTE, 1, {0x10, 0xb0}, {128, 255, 0, 64}},
        {8, PALETTE, 2, {0, 1, 2, 3}, {128, 255, 0, 64}},
        {8, COLOUR, 6, {9, 9, 9, 255, 255, 255, 0, 0, 0, 77, 77, 77}, {0, 77, 9, 255}},
        {8, GREY_ALPHA, 4, {5, 0, 6, 255, 7, 128, 8, 1}, {7, 8, 5, 6}},
    };
    for (size_t i = 0; i < sizeof kind / sizeof *kind; i++) {
        bytes png;
        make_png(&png, 2, 2, kind[i].depth, kind[i].colour, kind[i].rows, kind[i].row);
        store(file("kind.png"), png.data, png.size);
        uint8_t *value;
        int32_t size[3];
        if (CHECK_OK(volume_read_pictures(&value, size, file("kind.png")))) {
            CHECK(size[0] == 2 && size[1] == 2 && size[2] == 1);
            for (int k = 0; k < 4; k++)
                CHECK_EQUAL(kind[i].expected[k], value[k]);
            iso_release(value);
        }
    }
    forget("kind.png");
}

static void refused(const char *path, const char *word) {
    uint8_t *value;
    int32_t size[3];
    CHECK_STATUS(ISO_UNREADABLE, volume_read_pictures(&value, size, path));
    CHECK(value == NULL);
    if (!CHECK(strstr(iso_error_message(), word) != NULL))
        fprintf(stderr, "  no \"%s\" in: %s\n", word, iso_error_message());
}

static void test_bad_stacks(void) {
    refused(file("none.png"), "none.png");
    refused(file("none%d.png"), "neither");
    refused(folder, "no pictures");
    refused(file("a%sb.png"), "%03d");
    refused(file("a%nb.png"), "%03d");
    refused(file("a%d%d.png"), "%03d");
    refused(file("a%99999999d.png"), "digits");
    refused(file("a%*d.png"), "%03d");
    refused(file("a%"), "%03d");
    refused(file("a%0"), "%03d");
    refused(file("a%%.png"), "no such file");
    refused("", "");
    store_grey("s0.png", 4, 4, 0);
    store_grey("s1.png", 4, 5, 0);
    refused(file("s%d.png"), "s1.png: has 4 x 5 pixels");
    store(file("s1.png"), "P5 4 4 255 ................", 26);
    refused(file("s%d.png"), "s1.png: is no PNG");
    store(file("s1.png"), "", 0);
    refused(file("s%d.png"), "s1.png: is no PNG");
    /* a per cent sign in a name */
    store_grey("100%.png", 2, 2, 0);
    uint8_t *value;
    int32_t size[3];
    if (CHECK_OK(volume_read_pictures(&value, size, file("100%.png"))))
        iso_release(value);
    store_grey("50%-7.png", 2, 2, 0);
    rename(file("50%-7.png"), file("50%-1.png"));
    if (CHECK_OK(volume_read_pictures(&value, size, file("50%%-%d.png"))))
        iso_release(value);
    forget("50%-1.png");
    forget("100%.png");
    forget("s0.png");
    forget("s1.png");
}

static uint64_t seed = 88172645463325252u;

static uint64_t next_random(void) {
    seed ^= seed << 13;
    seed ^= seed >> 7;
    return seed ^= seed << 17;
}

/* The checksums are made right again half of the time, or nothing would get behind them. */
static void mend_sums(bytes *png) {
    for (size_t at = 8; at + 12 <= png->size;) {
        const unsigned char *p = png->data + at;
        size_t length = (size_t)p[0] << 24 | (size_t)p[1] << 16 | (size_t)p[2] << 8 | p[3];
        if (length > png->size - at - 12)
            return;
        uint32_t sum = 0xffffffffu;
        for (size_t i = at + 4; i < at + 8 + length; i++) {
            sum ^= png->data[i];
            for (int bit = 0; bit < 8; bit++)
                sum = sum & 1 ? 0xedb88320u ^ (sum >> 1) : sum >> 1;
        }
        bytes end = {.size = 0};
        put_big(&end, sum ^ 0xffffffffu);
        memcpy(png->data + at + 8 + length, end.data, 4);
        at += 12 + length;
    }
}

static void test_damaged_pictures(void) {
    unsigned char rows[60];
    for (size_t i = 0; i < sizeof rows; i++)
        rows[i] = (unsigned char)(3 * i);
    static const int colour[] = {GREY, PALETTE, COLOUR};
    int read = 0;
    for (int k = 0; k < 3; k++) {
        bytes sound;
        make_png(&sound, colour[k] == COLOUR ? 4 : 12, 5, 8, colour[k], rows, 12);
        for (size_t cut = 0; cut < sound.size; cut++) {
            store(file("cut.png"), sound.data, cut);
            refused(file("cut.png"), "cut.png: is no ");
        }
        for (int i = 0; i < 400; i++) {
            bytes bad = sound;
            for (int flips = 1 + (int)(next_random() % 3); flips > 0; flips--)
                bad.data[next_random() % bad.size] ^= (unsigned char)(1 << next_random() % 8);
            if (i % 2)
                mend_sums(&bad);
            store(file("cut.png"), bad.data, bad.size);
            uint8_t *value;
            int32_t size[3];
            iso_status status = volume_read_pictures(&value, size, file("cut.png"));
            if (status == ISO_OK) {
                read++;
                iso_release(value);
            } else {
                CHECK(status == ISO_UNREADABLE);
                CHECK(value == NULL);
            }
        }
    }
    CHECK(read > 10);
    forget("cut.png");
}

static void test_out_of_memory(void) {
    for (int i = 0; i < 3; i++) {
        char name[32];
        snprintf(name, sizeof name, "m%d.png", i);
        store_grey(name, 3, 3, i);
    }
    for (int way = 0; way < 2; way++) {
        int64_t n = 0;
        for (; n < 100; n++) {
            uint8_t *value;
            int32_t size[3];
            iso_fail_allocation_after(n);
            iso_status status =
                volume_read_pictures(&value, size, way == 0 ? file("m%d.png") : folder);
            iso_fail_allocation_after(-1);
            if (status == ISO_OK) {
                iso_release(value);
                break;
            }
            CHECK_EQUAL(ISO_NO_MEMORY, status);
            CHECK(value == NULL);
        }
        CHECK(n >= 7 && n < 100);
    }
    forget("m0.png");
    forget("m1.png");
    forget("m2.png");
}

int main(void) {
    if (!mkdtemp(folder))
        return 1;
    RUN(test_stack);
    RUN(test_kinds);
    RUN(test_bad_stacks);
    RUN(test_damaged_pictures);
    RUN(test_out_of_memory);
    CHECK(rmdir(folder) == 0);
    return check_verdict();
}
