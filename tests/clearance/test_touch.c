/* Distances of a part of the tool to a bead, against thin-walled truths. */
#include "check.h"

#include "base/random.h"
#include "clearance/touch.h"

static double between(uint64_t *state, double low, double high) {
    return low + (high - low) * random_unit(state);
}

/* Does the box at the origin, upright, meet a ball? Known in closed form. */
static void test_box_and_ball(void) {
    uint64_t state = 1;
    int met = 0;
    for (int i = 0; i < 20000; i++) {
        touch_sweep sweep = {
            .shape = {.low = 0, .high = 5, .box_low = {-2, -3}, .box_high = {4, 1}}};
        sweep.pose[0] = sweep.pose[1] =
            (tool_pose){vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
        touch_bead ball = {.ball = between(&state, 0.1, 2)};
        iso_vec3 at = vec3(between(&state, -5, 7), between(&state, -6, 4), between(&state, -3, 8));
        ball.center[0] = ball.center[1] = at;
        ball.normal[0] = ball.normal[1] = vec3(0, 0, 1);
        iso_vec3 nearest =
            vec3(fmin(4, fmax(-2, at.x)), fmin(1, fmax(-3, at.y)), fmin(5, fmax(0, at.z)));
        double gap = vec3_distance(nearest, at) - ball.ball;
        if (fabs(gap) < 2e-4)
            continue;
        met += gap < 0;
        CHECK_EQUAL(gap < 0, touch_meets(&sweep, &ball));
    }
    CHECK(met > 3000 && met < 17000);
}

/* The same of a cone with its tip cut off. */
static void test_cone_and_ball(void) {
    uint64_t state = 2;
    int met = 0;
    for (int i = 0; i < 20000; i++) {
        touch_sweep sweep = {
            .shape = {.low = 0, .high = 4, .round = true, .radius_low = 1, .radius_high = 4}};
        sweep.pose[0] = sweep.pose[1] =
            (tool_pose){vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
        touch_bead ball = {.ball = between(&state, 0.1, 1.5)};
        iso_vec3 at = vec3(between(&state, -6, 6), between(&state, -6, 6), between(&state, -2, 6));
        ball.center[0] = ball.center[1] = at;
        ball.normal[0] = ball.normal[1] = vec3(0, 0, 1);
        /* In the half-plane of r and z: the convex region with corners (1, 0), (4, 4). */
        double r = sqrt(at.x * at.x + at.y * at.y), gap;
        double t = fmin(1, fmax(0, ((r - 1) * 3 + at.z * 4) / 25));
        bool inside = at.z >= 0 && at.z <= 4 && (r - 1) * 4 <= at.z * 3;
        gap = sqrt((r - 1 - 3 * t) * (r - 1 - 3 * t) + (at.z - 4 * t) * (at.z - 4 * t));
        gap = fmin(gap, sqrt(pow(fmax(0, r - 1), 2) + at.z * at.z));
        gap = fmin(gap, sqrt(pow(fmax(0, r - 4), 2) + (at.z - 4) * (at.z - 4)));
        gap = (inside ? 0 : gap) - ball.ball;
        if (fabs(gap) < 2e-4)
            continue;
        met += gap < 0;
        CHECK_EQUAL(gap < 0, touch_meets(&sweep, &ball));
    }
    CHECK(met > 3000 && met < 17000);
}

/* A swept box is a larger box. */
static void test_sweep(void) {
    uint64_t state = 3;
    for (int i = 0; i < 5000; i++) {
        double way = between(&state, 0, 10);
        touch_sweep swept = {
            .shape = {.low = 0, .high = 5, .box_low = {-2, -3}, .box_high = {4, 1}}};
        swept.pose[0] = swept.pose[1] =
            (tool_pose){vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
        swept.pose[1].tip.y = way;
        touch_sweep large = swept;
        large.pose[1].tip.y = 0;
        large.shape.box_high.y += way;
        clearance_move move = {.width = between(&state, 0.2, 2),
                               .height = between(&state, 0.1, 0.5)};
        move.from = vec3(between(&state, -5, 7), between(&state, -6, 14), between(&state, -3, 8));
        move.to = vec3(between(&state, -5, 7), between(&state, -6, 14), between(&state, -3, 8));
        move.from_normal = vec3_unit(vec3(between(&state, -1, 1), between(&state, -1, 1), 1));
        move.to_normal = vec3_unit(vec3(between(&state, -1, 1), between(&state, -1, 1), 1));
        touch_bead bead = touch_bead_of(&move, false), thick = bead, thin = bead;
        thick.ball += 3e-4;
        thin.ball -= 3e-4;
        if (touch_meets(&large, &thin) == touch_meets(&large, &thick)) /* not on the border */
            CHECK_EQUAL(touch_meets(&large, &bead), touch_meets(&swept, &bead));
    }
}

int main(void) {
    RUN(test_box_and_ball);
    RUN(test_cone_and_ball);
    RUN(test_sweep);
    return check_verdict();
}
