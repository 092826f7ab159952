#include "channel/polyline.h"

iso_status polyline_new(polyline *line, const iso_vec3 *point, int32_t count, iso_arena *arena) {
    *line = (polyline){.point = point, .count = count};
    ISO_TRY(ISO_PUSH(line->length, arena, (int64_t)count + 1));
    line->length[0] = 0;
    for (int32_t i = 0; i < count; i++)
        line->length[i + 1] =
            line->length[i] + vec3_distance(point[i], point[i + 1 < count ? i + 1 : 0]);
    return ISO_OK;
}

/* The last edge that begins at `length` or before. */
static int32_t edge_at(const polyline *line, double length) {
    int32_t low = 0, high = line->count - 1;
    while (low < high) {
        int32_t middle = low + (high - low + 1) / 2;
        if (line->length[middle] <= length)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

static iso_vec3 end_of(const polyline *line, int32_t edge) {
    return line->point[edge + 1 < line->count ? edge + 1 : 0];
}

iso_vec3 polyline_at(const polyline *line, double length) {
    double whole = polyline_whole(line);
    if (!(whole > 0))
        return line->point[0];
    length -= whole * floor(length / whole);
    int32_t edge = edge_at(line, length);
    double side = line->length[edge + 1] - line->length[edge];
    return vec3_between(line->point[edge], end_of(line, edge),
                        side > 0 ? (length - line->length[edge]) / side : 0);
}

static double to_edge(double *length, const polyline *line, iso_vec3 p, int32_t edge) {
    iso_vec3 a = line->point[edge], along = vec3_minus(end_of(line, edge), a);
    double square = vec3_dot(along, along);
    double t = square > 0 ? vec3_dot(vec3_minus(p, a), along) / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    *length = line->length[edge] + t * (line->length[edge + 1] - line->length[edge]);
    return vec3_distance(p, vec3_along(a, t, along));
}

double polyline_nearest(double *length, const polyline *line, iso_vec3 p, int32_t *guess) {
    double best = to_edge(length, line, p, *guess);
    for (int32_t edge = 0; edge < line->count;) {
        double at, reach = vec3_distance(p, line->point[edge]) - best;
        if (line->length[edge + 1] - line->length[edge] < reach) {
            int32_t next = edge_at(line, line->length[edge] + reach);
            edge = next > edge ? next : edge + 1;
            continue;
        }
        double distance = to_edge(&at, line, p, edge);
        if (distance < best)
            best = distance, *length = at, *guess = edge;
        edge++;
    }
    return best;
}
