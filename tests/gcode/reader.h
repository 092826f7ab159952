/* Reads G-code back for the tests, with strtod and no knowledge of the writer: axes, filament,
 * feeds, comments. */
#ifndef TESTS_GCODE_READER_H
#define TESTS_GCODE_READER_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct reading {
    char *text;
    size_t size;
    double x, y, z, f;
    double e, start_of_e; /* as the machine counts; what G92 forgot */
    int relative;
    double drawn;                  /* mm of filament in moves of x, y */
    double pulled, fed;            /* mm in moves of E alone */
    double bead, travel;           /* mm */
    double bead_time, travel_time; /* s at the feeds given */
    double min_x, max_x, min_y, max_y;
    long moves, pulls, feeds, lines;
} reading;

static inline double reading_word(const char *line, const char *end, char letter,
                                  double otherwise) {
    for (const char *p = line; p < end && *p != ';'; p++)
        if (*p == letter)
            return strtod(p + 1, NULL);
    return otherwise;
}

static inline void reading_move(reading *r, const char *line, const char *end) {
    double x = reading_word(line, end, 'X', r->x), y = reading_word(line, end, 'Y', r->y);
    double z = reading_word(line, end, 'Z', r->z), none = -1e9;
    double e = reading_word(line, end, 'E', none), de = 0;
    r->f = reading_word(line, end, 'F', r->f);
    if (e != none) {
        de = r->relative ? e : e - r->e;
        r->e = r->relative ? r->e + e : e;
    }
    double length = sqrt((x - r->x) * (x - r->x) + (y - r->y) * (y - r->y));
    r->moves++;
    if (length > 0 && e != none) {
        r->drawn += de;
        r->bead += length;
        r->bead_time += length / r->f * 60;
        r->min_x = fmin(r->min_x, fmin(x, r->x));
        r->max_x = fmax(r->max_x, fmax(x, r->x));
        r->min_y = fmin(r->min_y, fmin(y, r->y));
        r->max_y = fmax(r->max_y, fmax(y, r->y));
    } else if (length > 0) {
        r->travel += length;
        r->travel_time += length / r->f * 60;
    } else if (de < 0) {
        r->pulled -= de;
        r->pulls++;
    } else if (de > 0) {
        r->fed += de;
        r->feeds++;
    }
    r->x = x;
    r->y = y;
    r->z = z;
}

static inline reading reading_of(const char *path) {
    reading r = {.min_x = 1e9, .min_y = 1e9, .max_x = -1e9, .max_y = -1e9};
    FILE *file = fopen(path, "rb");
    if (!file)
        return r;
    fseek(file, 0, SEEK_END);
    r.size = (size_t)ftell(file);
    rewind(file);
    r.text = calloc(r.size + 1, 1);
    if (fread(r.text, 1, r.size, file) != r.size)
        r.size = 0;
    fclose(file);
    for (char *line = r.text, *end; line < r.text + r.size; line = end + 1) {
        end = memchr(line, '\n', (size_t)(r.text + r.size - line));
        if (!end)
            break;
        r.lines++;
        if (!strncmp(line, "G1 ", 3))
            reading_move(&r, line, end);
        else if (!strncmp(line, "G92 E0", 6))
            r.e = 0;
        else if (!strncmp(line, "M83", 3) || !strncmp(line, "M82", 3))
            r.relative = line[2] == '3';
    }
    return r;
}

/* How often `text` begins a line. */
static inline long reading_count(const reading *r, const char *text) {
    long n = 0;
    size_t size = strlen(text);
    for (const char *line = r->text; line && *line; line = strchr(line, '\n')) {
        line += *line == '\n';
        n += !strncmp(line, text, size);
    }
    return n;
}

/* The number behind the first line that begins with `text`. */
static inline double reading_figure(const reading *r, const char *text) {
    const char *at = strstr(r->text, text);
    return at ? strtod(at + strlen(text), NULL) : -1;
}

#endif
