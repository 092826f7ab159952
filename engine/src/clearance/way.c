#include "clearance/way.h"

#include "clearance/tool.h"

/* Where the move is no more than `radius` from `center`: between[0] to between[1], empty if the
 * first is larger. */
static void near_point(double between[2], const clearance_move *move, iso_vec3 center,
                       double radius) {
    iso_vec3 way = vec3_minus(move->to, move->from), from = vec3_minus(move->from, center);
    double a = vec3_dot(way, way), b = vec3_dot(way, from);
    double c = vec3_dot(from, from) - radius * radius;
    between[0] = 1;
    between[1] = 0;
    if (a == 0) {
        if (c <= 0) {
            between[0] = 0;
            between[1] = 1;
        }
        return;
    }
    double square = b * b - a * c;
    if (square < 0)
        return;
    double root = sqrt(square);
    between[0] = most_of(0, (-b - root) / a);
    between[1] = least_of(1, (-b + root) / a);
}

int way_sections(way_section section[WAY_SECTIONS], const clearance_move *move, const way_run *run,
                 double tip_diameter) {
    if (is_bead(move)) {
        section[0] = (way_section){0, 1, move->height};
        return 1;
    }
    double near[2][2], cut[6] = {0, 1};
    const double height[2] = {run->begin_height, run->end_height};
    int cuts = 2, count = 0;
    near_point(near[0], move, run->begin, tip_diameter);
    near_point(near[1], move, run->end, tip_diameter);
    for (int i = 0; i < 4; i++) {
        double at = near[i / 2][i % 2];
        if (height[i / 2] > 0 && near[i / 2][0] <= near[i / 2][1] && at > 0 && at < 1)
            cut[cuts++] = at;
    }
    for (int i = 1; i < cuts; i++)
        for (int j = i; j > 0 && cut[j] < cut[j - 1]; j--) {
            double t = cut[j];
            cut[j] = cut[j - 1];
            cut[j - 1] = t;
        }
    for (int i = 0; i + 1 < cuts; i++) {
        double middle = (cut[i] + cut[i + 1]) / 2, raise = 0;
        for (int end = 0; end < 2; end++)
            if (height[end] > raise && near[end][0] <= middle && middle <= near[end][1])
                raise = height[end];
        if (cut[i] == cut[i + 1])
            continue;
        section[count++] = (way_section){cut[i], cut[i + 1], raise};
    }
    return count;
}

static iso_vec3 square_to(iso_vec3 normal, iso_vec3 way, double length) {
    iso_vec3 rest = vec3_along(normal, -vec3_dot(normal, way) / length, way);
    /* A line straight up has no side that is above. */
    return vec3_dot(rest, rest) > 0.25 ? vec3_unit(rest) : normal;
}

clearance_move way_bead(const clearance_move *move) {
    clearance_move bead = *move;
    iso_vec3 way = vec3_minus(move->to, move->from);
    double length = vec3_dot(way, way);
    if (length > 0) {
        bead.from_normal = square_to(move->from_normal, way, length);
        bead.to_normal = square_to(move->to_normal, way, length);
    }
    return bead;
}
