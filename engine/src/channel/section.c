#include <isoslice/channel.h>

#include <string.h>

#include "base/angle.h"
#include "base/vector.h"
#include "config/value.h"

#define SIZE_LEAST 0.1
#define SIZE_MOST 1000.0

static double turn(iso_vec2 a, iso_vec2 b) {
    return a.x * b.y - a.y * b.x;
}

double iso_channel_section_area(const iso_channel_section *section) {
    double twice = 0;
    for (int32_t i = 0; i < section->sides; i++)
        twice += turn(section->corner[i], section->corner[i + 1 < section->sides ? i + 1 : 0]);
    return twice / 2;
}

double iso_channel_section_reach(const iso_channel_section *section) {
    double most = 0;
    for (int32_t i = 0; i < section->sides; i++) {
        iso_vec2 c = section->corner[i];
        double length = sqrt(c.x * c.x + c.y * c.y);
        most = length > most ? length : most;
    }
    return most;
}

/* Corners of an ellipse, the first one at the angle `first`. */
static void round_one(iso_channel_section *s, double off, double along, double first) {
    for (int32_t i = 0; i < s->sides; i++) {
        double sine, cosine;
        iso_sine_cosine(&sine, &cosine, first + 360.0 * i / s->sides);
        s->corner[i] = (iso_vec2){off / 2 * cosine, along / 2 * sine};
    }
}

static void right_one(iso_channel_section *s, double off, double along) {
    s->sides = 4;
    for (int32_t i = 0; i < 4; i++)
        s->corner[i] =
            (iso_vec2){(i == 0 || i == 3 ? 0.5 : -0.5) * off, (i < 2 ? 0.5 : -0.5) * along};
}

/* "8", "8x5"; false: it is something else. */
static int read_sizes(double size[2], const char *text, char between) {
    size[1] = 0;
    if (!iso_number_read(&size[0], &text))
        return 0;
    if (*text == between) {
        text++;
        if (!iso_number_read(&size[1], &text))
            return 0;
        return *text == 0 ? 2 : 0;
    }
    return *text == 0 ? 1 : 0;
}

static int shape_of(const char **rest, const char *text) {
    static const char *const name[] = {"round:", "square:", "rect:", "oval:", "polygon:"};
    for (int i = 0; i < 5; i++) {
        size_t length = strlen(name[i]);
        if (strncmp(text, name[i], length) == 0) {
            *rest = text + length;
            return i;
        }
    }
    return -1;
}

static iso_status check_sizes(const double *size, int count, const char *text) {
    for (int i = 0; i < count; i++)
        if (!(size[i] >= SIZE_LEAST && size[i] <= SIZE_MOST))
            return iso_fail(ISO_USAGE, "section %.60s: sizes are %g to %g mm", text, SIZE_LEAST,
                            SIZE_MOST);
    return ISO_OK;
}

iso_status iso_channel_section_parse(iso_channel_section *section, const char *text,
                                     int32_t sides) {
    const char *rest = text;
    double size[2];
    int shape = shape_of(&rest, text),
        count = shape < 0 ? 0 : read_sizes(size, rest, shape == 4 ? ':' : 'x');
    *section = (iso_channel_section){.sides = sides};
    if (count != (shape < 2 ? 1 : 2))
        return iso_fail(ISO_USAGE,
                        "section %.60s: it is one of round:D, square:A, rect:AxB, oval:AxB and "
                        "polygon:SIDES:D, in mm, A along the part",
                        text);
    if (shape == 4) {
        if (!(size[0] >= 3 && size[0] <= ISO_SECTION_SIDES_MAX && size[0] == floor(size[0])))
            return iso_fail(ISO_USAGE, "section %.60s: a polygon has 3 to %d sides", text,
                            ISO_SECTION_SIDES_MAX);
        section->sides = (int32_t)size[0];
        ISO_TRY(check_sizes(size + 1, 1, text));
        round_one(section, size[1], size[1], 180.0 / section->sides);
        return ISO_OK;
    }
    if (sides < 3 || sides > ISO_SECTION_SIDES_MAX)
        return iso_fail(ISO_USAGE, "a section of %d sides; 3 to %d are possible", sides,
                        ISO_SECTION_SIDES_MAX);
    ISO_TRY(check_sizes(size, count, text));
    double off = count == 2 ? size[1] : size[0];
    if (shape == 0 || shape == 3)
        round_one(section, off, size[0], 0);
    else
        right_one(section, off, size[0]);
    return ISO_OK;
}
