#include "solid/enclosed.h"

typedef struct column_box {
    int32_t y[2], z[2];
} column_box;

static int32_t clamp_column(double at, int32_t count) {
    return at < 0 ? 0 : at >= count ? count - 1 : (int32_t)at;
}

static void find_columns(column_box *box, const enclosed_columns *columns, const iso_vec3 *t) {
    double y0 = t[0].y, y1 = t[0].y, z0 = t[0].z, z1 = t[0].z;
    for (int i = 1; i < 3; i++) {
        y0 = t[i].y < y0 ? t[i].y : y0;
        y1 = t[i].y > y1 ? t[i].y : y1;
        z0 = t[i].z < z0 ? t[i].z : z0;
        z1 = t[i].z > z1 ? t[i].z : z1;
    }
    box->y[0] = clamp_column((y0 - columns->y) / columns->pitch_y, columns->wide);
    box->y[1] = clamp_column((y1 - columns->y) / columns->pitch_y, columns->wide);
    box->z[0] = clamp_column((z0 - columns->z) / columns->pitch_z, columns->high);
    box->z[1] = clamp_column((z1 - columns->z) / columns->pitch_z, columns->high);
}

/* Some triangles a column: long ones must not fill the memory. */
static void choose_columns(enclosed_columns *columns, const iso_vec3 *corner, int64_t count) {
    double y0 = corner[0].y, y1 = y0, z0 = corner[0].z, z1 = z0;
    for (int64_t i = 1; i < 3 * count; i++) {
        y0 = corner[i].y < y0 ? corner[i].y : y0;
        y1 = corner[i].y > y1 ? corner[i].y : y1;
        z0 = corner[i].z < z0 ? corner[i].z : z0;
        z1 = corner[i].z > z1 ? corner[i].z : z1;
    }
    int32_t edge = 1;
    while ((int64_t)edge * edge < count && edge < 1024)
        edge *= 2;
    columns->wide = columns->high = edge;
    columns->y = y0;
    columns->z = z0;
    columns->pitch_y = y1 > y0 ? (y1 - y0) / edge : 1;
    columns->pitch_z = z1 > z0 ? (z1 - z0) / edge : 1;
}

iso_status enclosed_new(enclosed_columns *columns, const iso_vec3 *corner, int64_t count) {
    *columns = (enclosed_columns){.corner = corner};
    choose_columns(columns, corner, count);
    int64_t cells = (int64_t)columns->wide * columns->high, total = 0;
    column_box box;
    for (int64_t i = 0; i < count; i++) {
        find_columns(&box, columns, corner + 3 * i);
        total += (int64_t)(box.y[1] - box.y[0] + 1) * (box.z[1] - box.z[0] + 1);
    }
    if (total > INT32_MAX)
        return iso_fail(ISO_UNSLICEABLE, "too many long triangles to tell inside from outside");
    iso_status status = ISO_ALLOCATE(columns->first, cells + 2);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(columns->triangle, total);
    if (status != ISO_OK) {
        enclosed_free(columns);
        return status;
    }
    /* counted two places up, summed, then used as the next free place one up */
    memset(columns->first, 0, (size_t)(cells + 2) * sizeof *columns->first);
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t i = 0; i < count; i++) {
            find_columns(&box, columns, corner + 3 * i);
            for (int32_t z = box.z[0]; z <= box.z[1]; z++)
                for (int32_t y = box.y[0]; y <= box.y[1]; y++) {
                    int64_t cell = y + (int64_t)columns->wide * z;
                    if (pass == 0)
                        columns->first[cell + 2]++;
                    else
                        columns->triangle[columns->first[cell + 1]++] = (int32_t)i;
                }
        }
        for (int64_t c = 0; pass == 0 && c < cells; c++)
            columns->first[c + 2] += columns->first[c + 1];
    }
    return ISO_OK;
}

void enclosed_free(enclosed_columns *columns) {
    iso_release(columns->first);
    iso_release(columns->triangle);
    *columns = (enclosed_columns){0};
}

/* Which side of the edge a-b, seen along x, is the point on? The edge is taken in one sense
 * whichever triangle asks, and a point on it counts as left of it: as if the point stood a little
 * higher in z and, less by far, lower in y. So a ray meets one of two triangles that share an edge.
 */
static int side(const iso_vec3 *a, const iso_vec3 *b, const iso_vec3 *p) {
    int sense = 1;
    if (b->y < a->y || (b->y == a->y && b->z < a->z)) {
        const iso_vec3 *c = a;
        a = b;
        b = c;
        sense = -1;
    }
    double area = (b->y - a->y) * (p->z - a->z) - (b->z - a->z) * (p->y - a->y);
    return area >= 0 ? sense : -sense;
}

/* +1, -1: the ray from p towards larger x goes out through the triangle, or in. */
static int crossing(const iso_vec3 *t, const iso_vec3 *p) {
    int turn = side(&t[0], &t[1], p);
    if (side(&t[1], &t[2], p) != turn || side(&t[2], &t[0], p) != turn)
        return 0;
    double ax = t[0].x - p->x, ay = t[0].y - p->y, az = t[0].z - p->z;
    double bx = t[1].x - p->x, by = t[1].y - p->y, bz = t[1].z - p->z;
    double cx = t[2].x - p->x, cy = t[2].y - p->y, cz = t[2].z - p->z;
    double volume = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
    return turn > 0 ? volume > 0 : -(volume < 0);
}

iso_status enclosed_inside(void *payload, uint8_t *inside, const iso_vec3 *point, int64_t count) {
    const enclosed_columns *columns = payload;
    for (int64_t i = 0; i < count; i++) {
        const iso_vec3 *p = &point[i];
        double y = (p->y - columns->y) / columns->pitch_y;
        double z = (p->z - columns->z) / columns->pitch_z;
        inside[i] = 0;
        if (!(y >= 0 && y <= columns->wide && z >= 0 && z <= columns->high))
            continue;
        int64_t cell = clamp_column(y, columns->wide) +
                       (int64_t)columns->wide * clamp_column(z, columns->high);
        int32_t winding = 0;
        for (int32_t k = columns->first[cell]; k < columns->first[cell + 1]; k++)
            winding += crossing(columns->corner + 3 * (int64_t)columns->triangle[k], p);
        inside[i] = winding != 0;
    }
    return ISO_OK;
}
