#include "mesh/stl_write.h"

#include <math.h>
#include <string.h>

#include "base/output.h"

static void put_number(uint8_t *to, uint32_t bits) {
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(bits >> 8 * i);
}

static void put_float(uint8_t *to, float number) {
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    put_number(to, bits);
}

/* Normal, corners, and two bytes of nothing. */
static void put_triangle(uint8_t to[50], const float t[9]) {
    double u[3], v[3], n[3], size;
    for (int i = 0; i < 3; i++)
        u[i] = (double)t[3 + i] - (double)t[i], v[i] = (double)t[6 + i] - (double)t[i];
    for (int i = 0; i < 3; i++)
        n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
    size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++)
        put_float(to + 4 * i, size > 0 ? (float)(n[i] / size) : 0);
    for (int i = 0; i < 9; i++)
        put_float(to + 12 + 4 * i, t[i]);
    to[48] = to[49] = 0;
}

iso_status stl_write(const char *path, const char *title, const float *triangle, int64_t count) {
    enum { AT_ONCE = 1024 };
    uint8_t text[80] = {0}, buffer[50 * AT_ONCE], number[4];
    iso_output *output;
    if (count > UINT32_MAX)
        return iso_fail(ISO_NOT_WRITTEN, "%s: more triangles than an STL file can count", path);
    size_t length = strlen(title);
    memcpy(text, title, length < sizeof text ? length : sizeof text);
    ISO_TRY(iso_output_open(&output, path));
    iso_output_write(output, text, sizeof text);
    put_number(number, (uint32_t)count);
    iso_output_write(output, number, sizeof number);
    for (int64_t first = 0; first < count; first += AT_ONCE) {
        int64_t n = count - first < AT_ONCE ? count - first : AT_ONCE;
        for (int64_t i = 0; i < n; i++)
            put_triangle(buffer + 50 * i, triangle + 9 * (first + i));
        iso_output_write(output, buffer, (size_t)(50 * n));
    }
    return iso_output_commit(output);
}
