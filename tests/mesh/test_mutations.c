/* Bytes of good files changed, dropped and repeated, thousands of times: each ends with a sound
 * mesh or a status and a message, never with a crash. */
#include "check.h"

#include "mesh/stl.h"
#include "models/shapes.h"

static int read_ok, refused;

static void try_bytes(const unsigned char *bytes, int64_t size) {
    iso_mesh mesh;
    iso_status status = iso_mesh_read_memory(&mesh, bytes, size);
    if (status == ISO_OK) {
        read_ok++;
        CHECK_OK(iso_mesh_validate(&mesh));
        CHECK(iso_mesh_volume(&mesh) - iso_mesh_volume(&mesh) == 0);
        iso_mesh_free(&mesh);
        return;
    }
    refused++;
    CHECK(status == ISO_UNREADABLE || status == ISO_UNSLICEABLE);
    CHECK(mesh.origin == NULL && iso_error_message()[0] != 0);
}

static int64_t mutate(unsigned char *bytes, int64_t size, uint64_t *state, const char *tokens) {
    int changes = 1 + (int)(shape_random(state) % 4);
    for (int i = 0; i < changes && size > 0; i++) {
        int64_t at = shape_random(state) % (uint32_t)size;
        int64_t length = 1 + shape_random(state) % 60;
        length = length < size - at ? length : size - at;
        int64_t from = shape_random(state) % (uint32_t)(size - length + 1);
        switch (shape_random(state) % 6) {
        case 0:
            bytes[at] = (unsigned char)shape_random(state);
            break;
        case 1:
            bytes[at] ^= (unsigned char)(1u << shape_random(state) % 8);
            break;
        case 2: /* drop a piece */
            memmove(bytes + at, bytes + at + length, (size_t)(size - at - length));
            size -= length;
            break;
        case 3: /* copy a piece elsewhere */
            memmove(bytes + from, bytes + at, (size_t)length);
            break;
        case 4:
            size = at;
            break;
        default:
            bytes[at] = (unsigned char)tokens[shape_random(state) % strlen(tokens)];
        }
    }
    return size;
}

static void mutations(const unsigned char *original, int64_t size, const char *tokens, int rounds) {
    uint64_t state = 11;
    unsigned char *bytes = malloc((size_t)size);
    read_ok = refused = 0;
    for (int i = 0; i < rounds; i++) {
        memcpy(bytes, original, (size_t)size);
        int64_t left = mutate(bytes, size, &state, tokens);
        /* of its exact size, so that the sanitizer sees any step beyond its end */
        unsigned char *exact = malloc(left ? (size_t)left : 1);
        memcpy(exact, bytes, (size_t)left);
        try_bytes(exact, left);
        free(exact);
    }
    free(bytes);
    CHECK(read_ok > rounds / 100);
    CHECK(refused > rounds / 100);
}

static void test_binary_mutations(void) {
    shape s = {0};
    shape_torus(&s, (shape_point){0, 0, 0}, 3, 1, 8, 6);
    shape_box(&s, 10, 0, 0, 12, 2, 2);
    unsigned char *bytes = shape_binary(&s, "solid or not");
    mutations(bytes, 84 + 50 * s.count, "solid\177\200\377", 6000);
    free(bytes);
    shape_free(&s);
}

static void test_ascii_mutations(void) {
    shape s = {0};
    shape_box(&s, 10, 0, 0, 12, 2, 2);
    shape_tetrahedron(&s, 3);
    char *text = shape_ascii(&s, "box", "\r\n");
    mutations((unsigned char *)text, (int64_t)strlen(text), "0123456789eE+-. \n\rsolidfacetnavx",
              6000);
    free(text);
    shape_free(&s);
}

static shape_point corner_of(uint64_t *state, uint32_t side) {
    shape_point p;
    p.x = shape_random(state) % side;
    p.y = shape_random(state) % side;
    p.z = shape_random(state) % side;
    return p;
}

/* Tetrahedra on few corners, most of them flat or in one another, some with a triangle less: every
 * kind of defect at once. */
static void test_random_soups(void) {
    uint64_t state = 2;
    int mended = 0;
    for (int round = 0; round < 6000; round++) {
        shape s = {0};
        int count = 1 + (int)(shape_random(&state) % 12);
        for (int i = 0; i < count; i++) {
            shape_point p[4];
            for (int k = 0; k < 4; k++)
                p[k] = corner_of(&state, 2 + (uint32_t)round % 3);
            shape_add(&s, p[0], p[2], p[1]);
            shape_add(&s, p[0], p[1], p[3]);
            shape_add(&s, p[1], p[2], p[3]);
            shape_add(&s, p[2], p[0], p[3]);
        }
        for (uint32_t i = shape_random(&state) % 3; i > 0; i--)
            shape_remove(&s, shape_random(&state) % s.count);
        iso_mesh mesh;
        iso_status status = iso_mesh_from_triangles(&mesh, s.triangle, s.count);
        CHECK(status == ISO_OK || status == ISO_UNSLICEABLE);
        if (status == ISO_OK) {
            mended++;
            CHECK_OK(iso_mesh_validate(&mesh));
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
    CHECK(mended > 1000);
}

int main(void) {
    RUN(test_binary_mutations);
    RUN(test_ascii_mutations);
    RUN(test_random_soups);
    return check_verdict();
}
