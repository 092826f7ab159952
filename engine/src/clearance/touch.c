#include "clearance/touch.h"

touch_bead touch_bead_of(const clearance_move *move, bool upright) {
    /* What is narrower than high hangs in the air: its upper end is what counts. */
    double across = least_of(move->width, move->height);
    touch_bead bead = {.normal = {move->from_normal, move->to_normal},
                       .disc = (move->width - across) / 2,
                       .ball = across / 2};
    bead.center[0] = vec3_along(move->from, -bead.ball, move->from_normal);
    bead.center[1] = vec3_along(move->to, -bead.ball, move->to_normal);
    iso_vec3 way = vec3_unit(vec3_minus(move->to, move->from));
    for (int end = 0; end < 2; end++) {
        if (fabs(vec3_dot(bead.normal[end], way)) > 1e-3)
            continue; /* too steep to have an end; its discs are whole */
        bead.side[end] = vec3_unit(vec3_cross(bead.normal[end], way));
        iso_vec3 out = end ? way : vec3_times(way, -1);
        if (upright && out.z > 0)
            out.z = 0;
        out = vec3_along(out, -vec3_dot(out, bead.side[end]), bead.side[end]);
        bead.out[end] = vec3_unit(out);
    }
    return bead;
}

iso_vec3 touch_sweep_support(const touch_sweep *sweep, iso_vec3 direction) {
    iso_vec3 from = tool_support(&sweep->shape, &sweep->pose[0], direction);
    iso_vec3 to = tool_support(&sweep->shape, &sweep->pose[1], direction);
    return vec3_dot(from, direction) >= vec3_dot(to, direction) ? from : to;
}

static iso_vec3 disc_support(const touch_bead *bead, int end, iso_vec3 direction) {
    iso_vec3 normal = bead->normal[end], side = bead->side[end];
    if (vec3_dot(side, side) > 0.5) {
        double along = vec3_dot(direction, side);
        double out = most_of(0, vec3_dot(direction, bead->out[end]));
        double size = along * along + out * out;
        if (size <= 1e-20 * vec3_dot(direction, direction))
            return bead->center[end];
        double scale = bead->disc / sqrt(size);
        iso_vec3 at = vec3_along(bead->center[end], along * scale, side);
        return vec3_along(at, out * scale, bead->out[end]);
    }
    iso_vec3 across = vec3_along(direction, -vec3_dot(direction, normal), normal);
    /* What rounding leaves of a direction straight up may point anywhere. */
    double size = vec3_dot(across, across);
    if (size <= 1e-20 * vec3_dot(direction, direction))
        return bead->center[end];
    return vec3_along(bead->center[end], bead->disc / sqrt(size), across);
}

iso_vec3 touch_bead_support(const touch_bead *bead, iso_vec3 direction) {
    iso_vec3 from = disc_support(bead, 0, direction), to = disc_support(bead, 1, direction);
    return vec3_dot(from, direction) >= vec3_dot(to, direction) ? from : to;
}

/* Up to four points of the difference, and the bead's points they came from. */
typedef struct simplex {
    int count;
    iso_vec3 at[4], bead[4];
    double weight[4]; /* of the point nearest to the origin */
} simplex;

static iso_vec3 nearest_of(const simplex *s) {
    iso_vec3 sum = vec3(0, 0, 0);
    for (int i = 0; i < s->count; i++)
        sum = vec3_along(sum, s->weight[i], s->at[i]);
    return sum;
}

/* Keep the named corners, with weights. */
static void keep(simplex *s, int count, const int *corner, const double *weight) {
    simplex kept = {.count = count};
    for (int i = 0; i < count; i++) {
        kept.at[i] = s->at[corner[i]];
        kept.bead[i] = s->bead[corner[i]];
        kept.weight[i] = weight[i];
    }
    *s = kept;
}

static void nearest_of_edge(simplex *s, int a, int b) {
    iso_vec3 edge = vec3_minus(s->at[b], s->at[a]);
    double along = -vec3_dot(s->at[a], edge), length = vec3_dot(edge, edge);
    if (along <= 0)
        keep(s, 1, (int[]){a}, (double[]){1});
    else if (along >= length)
        keep(s, 1, (int[]){b}, (double[]){1});
    else
        keep(s, 2, (int[]){a, b}, (double[]){1 - along / length, along / length});
}

static void nearest_of_triangle(simplex *s, int a, int b, int c) {
    iso_vec3 u = vec3_minus(s->at[b], s->at[a]), v = vec3_minus(s->at[c], s->at[a]);
    iso_vec3 normal = vec3_cross(u, v);
    double size = vec3_dot(normal, normal);
    /* Areas of the triangles that the origin makes with the edges, times twice the whole. */
    double weight[3];
    const int corner[3] = {a, b, c};
    bool inside = size > 0;
    for (int i = 0; i < 3; i++) {
        iso_vec3 p = s->at[corner[(i + 1) % 3]], q = s->at[corner[(i + 2) % 3]];
        weight[i] = vec3_dot(vec3_cross(p, q), normal);
        inside = inside && weight[i] > 0;
    }
    if (inside) {
        double sum = weight[0] + weight[1] + weight[2]; /* size, but for rounding */
        for (int i = 0; i < 3; i++)
            weight[i] /= sum;
        keep(s, 3, corner, weight);
        return;
    }
    simplex best = *s;
    double least = INFINITY;
    for (int i = 0; i < 3; i++) {
        simplex edge = *s;
        nearest_of_edge(&edge, corner[i], corner[(i + 1) % 3]);
        iso_vec3 nearest = nearest_of(&edge);
        double distance = vec3_dot(nearest, nearest);
        if (distance < least) {
            least = distance;
            best = edge;
        }
    }
    *s = best;
}

/* All four corners stay if the origin is inside. A flat tetrahedron may claim that by rounding; its
 * weights then don't lead to the origin. */
static void nearest_of_tetrahedron(simplex *s, bool flat) {
    static const int face[4][4] = {{1, 2, 3, 0}, {0, 2, 3, 1}, {0, 1, 3, 2}, {0, 1, 2, 3}};
    simplex best = *s;
    double least = INFINITY, weight[4], sum = 0;
    for (int i = 0; i < 4; i++) {
        const int *f = face[i];
        iso_vec3 a = s->at[f[0]];
        iso_vec3 normal = vec3_cross(vec3_minus(s->at[f[1]], a), vec3_minus(s->at[f[2]], a));
        double other = vec3_dot(vec3_minus(s->at[f[3]], a), normal);
        double origin = -vec3_dot(a, normal);
        weight[i] = fabs(origin);
        sum += weight[i];
        if (!flat && other != 0 && (other > 0) == (origin > 0))
            continue;
        simplex triangle = *s;
        nearest_of_triangle(&triangle, f[0], f[1], f[2]);
        iso_vec3 nearest = nearest_of(&triangle);
        double distance = vec3_dot(nearest, nearest);
        if (distance < least) {
            least = distance;
            best = triangle;
        }
    }
    if (least < INFINITY) {
        *s = best;
        return;
    }
    for (int i = 0; i < 4; i++)
        weight[i] /= sum;
    best = *s;
    keep(s, 4, (int[]){0, 1, 2, 3}, weight);
    if (!(vec3_length(nearest_of(s)) < 1e-6)) {
        *s = best;
        nearest_of_tetrahedron(s, true);
    }
}

static void reduce(simplex *s) {
    switch (s->count) {
    case 1:
        s->weight[0] = 1;
        break;
    case 2:
        nearest_of_edge(s, 0, 1);
        break;
    case 3:
        nearest_of_triangle(s, 0, 1, 2);
        break;
    default:
        nearest_of_tetrahedron(s, false);
    }
}

/* The distance of the sweep to the bead without its ball, to 0.1 um; or any number that is, as it
 * is, no more than `near`, or more than `far`. *s says where, if it isn't more than that. */
static double distance_of(simplex *s, const touch_sweep *sweep, const touch_bead *bead, double near,
                          double far) {
    enum { ROUNDS = 100 };
    /* Most are apart across the layer: any direction will do to begin with. */
    iso_vec3 way = vec3_plus(bead->normal[0], bead->normal[1]);
    double distance = INFINITY, least = 0;
    s->count = 0;
    for (int round = 0; round < ROUNDS; round++) {
        iso_vec3 there = touch_bead_support(bead, way);
        iso_vec3 here = touch_sweep_support(sweep, vec3_times(way, -1));
        iso_vec3 at = vec3_minus(here, there);
        double length = vec3_length(way);
        if (length > 0) {
            least = most_of(least, vec3_dot(way, at) / length);
            if (least > far)
                return least;
            if (distance - least < 1e-4)
                return distance;
        }
        simplex before = *s;
        s->at[s->count] = at;
        s->bead[s->count++] = there;
        reduce(s);
        iso_vec3 nearest = nearest_of(s);
        double now = vec3_length(nearest);
        if (now <= near || s->count == 4)
            return now;
        if (now >= distance) { /* rounding: this is as near as it gets */
            *s = before;
            return distance;
        }
        distance = now;
        way = nearest;
    }
    return distance;
}

bool touch_meets(const touch_sweep *sweep, const touch_bead *bead) {
    simplex s;
    return distance_of(&s, sweep, bead, bead->ball, bead->ball) <= bead->ball;
}

iso_vec3 touch_place(const touch_sweep *sweep, const touch_bead *bead) {
    simplex s;
    double distance = distance_of(&s, sweep, bead, 0, INFINITY);
    iso_vec3 at = vec3(0, 0, 0);
    for (int i = 0; i < s.count; i++)
        at = vec3_along(at, s.weight[i], s.bead[i]);
    if (distance > 0)
        at = vec3_along(at, least_of(1, bead->ball / distance), nearest_of(&s));
    return at;
}
