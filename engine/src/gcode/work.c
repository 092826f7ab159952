#include "gcode/work.h"

#include <math.h>
#include <stddef.h>

static double length_between(const iso_path_vertex *a, const iso_path_vertex *b) {
    double dx = (double)b->at.x - a->at.x, dy = (double)b->at.y - a->at.y;
    double dz = (double)b->z - a->z;
    return sqrt(dx * dx + dy * dy + dz * dz); /* of an integer below 2^53: rounded once */
}

/* From `end` by way of the points where the travel turns; and what of that goes along the layer,
 * without the ways up from it and down again where it isn't flat. */
static double length_of_travel(double *along, const iso_paths *paths, const iso_path *path,
                               const iso_path_vertex *end) {
    iso_path_vertex at = *end;
    double sum = 0, up = 0;
    for (int32_t i = 0; i < path->travel_count; i++) {
        iso_path_vertex turn = at;
        turn.at = paths->travel[path->travel_first + i];
        if (paths->travel_frame)
            turn.z = paths->travel_frame[path->travel_first + i].z;
        sum += length_between(&at, &turn);
        up = i == 0 && paths->travel_frame ? sum : up;
        at = turn;
    }
    double down = length_between(&at, &paths->vertex[path->first]);
    *along = paths->travel_frame && path->travel_count > 0 ? sum - up : sum + down;
    return sum + down;
}

/* Does the path turn by more than 45 degrees behind vertex b? */
static int turns(const iso_path_vertex *a, const iso_path_vertex *b, const iso_path_vertex *c,
                 double ab, double bc) {
    double dot = ((double)b->at.x - a->at.x) * ((double)c->at.x - b->at.x) +
                 ((double)b->at.y - a->at.y) * ((double)c->at.y - b->at.y) +
                 ((double)b->z - a->z) * ((double)c->z - b->z);
    return dot < 0.7 * ab * bc;
}

/* A bead whose section the flow is too small for. */
static void count_limited(iso_layer_work *work, const iso_layer_pace *pace, int slot, double area,
                          double mm) {
    int32_t feed = iso_pace_limited_feed(pace, slot, area), bin = feed / ISO_FEED_BIN;
    double time = mm * 60 / feed;
    bin = bin < ISO_FEED_BINS ? bin : ISO_FEED_BINS - 1;
    if (iso_role_is_bridge(slot / 2)) {
        work->other_time += time;
    } else {
        work->limited_length[bin] += mm;
        work->limited_time[bin] += time;
    }
}

/* Lengths of the path's segments, and what they ask for. */
static void measure_path(iso_layer_work *work, double *length, const iso_path *path,
                         const iso_path_vertex *vertex, const iso_layer_pace *pace) {
    int32_t last = path->count - 1, segments = last + path->closed;
    int slot = iso_speed_slot(vertex[0].role, path->speed_class);
    double sum = 0, stops = 1;
    for (int32_t k = 0; k < segments; k++) {
        const iso_path_vertex *to = k < last ? &vertex[k + 1] : vertex;
        int own = iso_speed_slot(vertex[k].role, path->speed_class);
        length[k] = length_between(&vertex[k], to);
        if (own != slot) {
            work->length[slot] += sum / ISO_UNITS_PER_MM;
            work->stops[slot] += stops;
            sum = stops = 0;
            slot = own;
        }
        stops += k > 0 && turns(&vertex[k - 1], &vertex[k], to, length[k - 1], length[k]);
        if (vertex[k].area > pace->most_area[slot])
            count_limited(work, pace, slot, vertex[k].area, length[k] / ISO_UNITS_PER_MM);
        else
            sum += length[k];
    }
    work->length[slot] += sum / ISO_UNITS_PER_MM;
    work->stops[slot] += stops;
}

/* s from stop to stop. */
static double travel_time(const iso_head *head, double mm) {
    double speed = head->travel_feed / 60.0, acceleration = head->options->limits.travel;
    if (head->travel_acceleration > 0 && head->travel_acceleration < acceleration)
        acceleration = head->travel_acceleration;
    return mm < speed * speed / acceleration ? 2 * sqrt(mm / acceleration)
                                             : mm / speed + speed / acceleration;
}

void iso_work_measure(iso_layer_work *work, double *length, const iso_paths *paths,
                      const iso_layer_pace *pace, const iso_head *head) {
    const iso_path_vertex *end = NULL;
    double shortest = head->options->retract_before_travel * ISO_UNITS_PER_MM;
    double retraction_time = iso_head_retraction_time(head);
    *work = (iso_layer_work){0};
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        const iso_path_vertex *vertex = paths->vertex + path->first;
        if (path->count < 2)
            continue;
        measure_path(work, length + path->first, path, vertex, pace);
        if (end) {
            double along, units = length_of_travel(&along, paths, path, end);
            work->other_time += travel_time(head, units / ISO_UNITS_PER_MM);
            if (path->retract != ISO_RETRACT_NOT && along > shortest)
                work->other_time += retraction_time;
        }
        end = &vertex[path->closed ? 0 : path->count - 1];
    }
}
