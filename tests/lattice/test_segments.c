/* Distances from segments, against all of them. */
#include "check.h"

#include <math.h>

#include "base/random.h"
#include "lattice/segments.h"

enum { SIZE = 64, SEGMENTS_MOST = 40 };

static double square_to(const iso_segment *s, const double *p) {
    double t = 0, length = 0, square = 0;
    for (int a = 0; a < 3; a++) {
        t += (p[a] - s->from[a]) * s->way[a];
        length += (double)s->way[a] * s->way[a];
    }
    t = fmin(1, fmax(0, t / length));
    for (int a = 0; a < 3; a++) {
        double way = p[a] - s->from[a] - t * s->way[a];
        square += way * way;
    }
    return square;
}

static double nearest(const iso_segment *segment, int32_t count, const int32_t at[3]) {
    double least = HUGE_VAL;
    for (int32_t period = 0; period < 125; period++) {
        double p[3] = {at[0] + SIZE * (period % 5 - 2.0), at[1] + SIZE * (period / 5 % 5 - 2.0),
                       at[2] + SIZE * (period / 25 - 2.0)};
        for (int32_t s = 0; s < count; s++)
            least = fmin(least, square_to(&segment[s], p));
    }
    return sqrt(least);
}

/* Few, so that the nearest one may be blocks away, and many. */
static void test_random_segments(void) {
    static float distance[SIZE * SIZE * SIZE];
    iso_segment segment[SEGMENTS_MOST];
    uint64_t seed = 11;
    for (int32_t count = 1; count <= SEGMENTS_MOST; count *= 3) {
        for (int32_t s = 0; s < count; s++)
            for (int a = 0; a < 3; a++) {
                segment[s].from[a] = (float)(SIZE * random_unit(&seed));
                segment[s].way[a] = (float)(12 * random_unit(&seed) - 6);
            }
        CHECK_OK(distance_from_segments(distance, SIZE, segment, count));
        double worst = 0;
        for (int32_t k = 0; k < 4000; k++) {
            int32_t i = (int32_t)(random_unit(&seed) * SIZE * SIZE * SIZE);
            const int32_t at[3] = {i % SIZE, i / SIZE % SIZE, i / SIZE / SIZE};
            worst = fmax(worst, fabs(distance[i] - nearest(segment, count, at)));
        }
        CHECK_NEAR(0, worst, 1e-4);
    }
}

int main(void) {
    RUN(test_random_segments);
    return check_verdict();
}
