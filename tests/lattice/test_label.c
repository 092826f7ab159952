/* Pieces against a flood of the whole grid, which needs all of it at once. */
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "lattice/label.h"

enum { NX = 23, NY = 17, NZ = 19, N = NX * NY * NZ };

static uint8_t voxel[N];
static int32_t stack[N];

static uint64_t state;

static uint32_t next_random(void) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33);
}

static void make_random(uint64_t seed, uint32_t percent) {
    state = seed;
    for (int i = 0; i < N; i++)
        voxel[i] = next_random() % 100 < percent;
}

/* Voxels, and whether the border is touched, of the piece that `seed` is in; its voxels become 2.
 */
static int64_t flood(int *on_border, int32_t seed, int reach) {
    int64_t count = 0, top = 0;
    *on_border = 0;
    voxel[seed] = 2;
    stack[top++] = seed;
    while (top > 0) {
        int32_t at = stack[--top], x = at % NX, y = at / NX % NY, z = at / NX / NY;
        count++;
        *on_border |= x == 0 || y == 0 || z == 0 || x == NX - 1 || y == NY - 1 || z == NZ - 1;
        for (int k = -1; k <= 1; k++)
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++) {
                    int a = x + i, b = y + j, c = z + k;
                    if (abs(i) + abs(j) + abs(k) > reach || a < 0 || b < 0 || c < 0 || a >= NX ||
                        b >= NY || c >= NZ || voxel[a + NX * (b + NY * c)] != 1)
                        continue;
                    voxel[a + NX * (b + NY * c)] = 2;
                    stack[top++] = a + NX * (b + NY * c);
                }
    }
    return count;
}

static iso_status label_all(iso_labels *labels, iso_joining joining, int keep_all, int64_t most) {
    ISO_TRY(labels_begin(labels, joining, NX, NY, NZ));
    labels->keep_all = keep_all;
    labels->done_most = most;
    for (int k = 0; k < NZ; k++)
        ISO_TRY(labels_plane(labels, voxel + (int64_t)NX * NY * k, 1, 1, NULL));
    return labels_end(labels);
}

static void check_pieces(iso_joining joining, int keep_all) {
    iso_labels labels = {0};
    int reach = joining == ISO_JOIN_FACES ? 1 : 3;
    int64_t total = 0;
    CHECK_OK(label_all(&labels, joining, keep_all, 1000000));
    for (int i = 0; i < N; i++)
        total += voxel[i];
    for (int64_t p = 0; p < labels.done_count; p++) {
        const iso_piece *piece = &labels.done[p];
        int32_t seed = piece->seed[0] + NX * (piece->seed[1] + NY * piece->seed[2]);
        int on_border;
        if (!CHECK_EQUAL(1, voxel[seed])) /* of no other piece */
            break;
        CHECK_EQUAL(piece->voxels, flood(&on_border, seed, reach));
        CHECK_EQUAL(on_border, piece->on_border);
        int earlier = 0; /* the seed is the first voxel of its piece */
        for (int32_t i = 0; i < seed; i++)
            earlier += voxel[i] == 2;
        CHECK_EQUAL(0, earlier);
        int32_t low[3] = {NX, NY, NZ}, high[3] = {-1, -1, -1};
        for (int32_t i = 0; i < N; i++) {
            const int32_t at[3] = {i % NX, i / NX % NY, i / NX / NY};
            for (int axis = 0; axis < 3 && voxel[i] == 2; axis++) {
                low[axis] = at[axis] < low[axis] ? at[axis] : low[axis];
                high[axis] = at[axis] > high[axis] ? at[axis] : high[axis];
            }
            if (voxel[i] == 2)
                voxel[i] = 3;
        }
        CHECK(memcmp(low, piece->min, sizeof low) == 0 &&
              memcmp(high, piece->max, sizeof high) == 0);
        total -= piece->voxels;
    }
    CHECK_EQUAL(0, total);
    labels_free(&labels);
}

static void test_pieces_are_those_of_a_flood(void) {
    static const uint32_t percent[] = {5, 12, 25, 31, 45, 70, 100};
    for (int i = 0; i < 7; i++)
        for (int joining = ISO_JOIN_FACES; joining <= ISO_JOIN_CORNERS; joining++)
            for (int keep_all = 0; keep_all < 2; keep_all++) {
                make_random((uint64_t)(7 * i + joining), percent[i]);
                check_pieces(joining, keep_all);
            }
}

/* A U is one piece from the plane on where its arms meet; two arms are two before. */
static void test_what_meets_later_is_one(void) {
    memset(voxel, 0, sizeof voxel);
    for (int z = 2; z < 9; z++)
        voxel[3 + NX * (4 + NY * z)] = voxel[9 + NX * (4 + NY * z)] = 1;
    for (int x = 3; x <= 9; x++)
        voxel[x + NX * (4 + NY * 9)] = 1;
    iso_labels labels = {0};
    CHECK_OK(label_all(&labels, ISO_JOIN_FACES, 0, 1000));
    CHECK_EQUAL(1, labels.done_count);
    CHECK_EQUAL(21, labels.done[0].voxels);
    CHECK_EQUAL(0, labels.done[0].on_border);
    labels_free(&labels);
}

/* Where there are more than can be listed, the largest are, and the rest is counted. */
static void test_crumbs_are_only_counted(void) {
    make_random(99, 20);
    iso_labels all = {0}, some = {0};
    int64_t voxels = 0, largest[2] = {0, 0};
    CHECK_OK(label_all(&all, ISO_JOIN_FACES, 0, 1000000));
    CHECK_OK(label_all(&some, ISO_JOIN_FACES, 0, 40));
    CHECK(all.done_count > 400);
    CHECK(some.done_count <= 40);
    CHECK_EQUAL(all.done_count, some.done_count + some.lost);
    for (int64_t i = 0; i < all.done_count; i++) {
        voxels += all.done[i].voxels;
        largest[0] = all.done[i].voxels > largest[0] ? all.done[i].voxels : largest[0];
    }
    for (int64_t i = 0; i < some.done_count; i++) {
        voxels -= some.done[i].voxels;
        largest[1] = some.done[i].voxels > largest[1] ? some.done[i].voxels : largest[1];
    }
    CHECK_EQUAL(voxels, some.lost_voxels);
    CHECK_EQUAL(largest[0], largest[1]);
    labels_free(&all);
    labels_free(&some);
}

int main(void) {
    RUN(test_pieces_are_those_of_a_flood);
    RUN(test_what_meets_later_is_one);
    RUN(test_crumbs_are_only_counted);
    return check_verdict();
}
