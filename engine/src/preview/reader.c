#include "preview/reader.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/memory.h"

#define PI 3.14159265358979323846

enum { LONGEST_AXIS = 10000, WIDEST_BEAD = 100 }; /* mm; more is not a printer's */

iso_status iso_preview_text_read(iso_preview_text *text, const char *path) {
    *text = (iso_preview_text){.path = path};
    bool standard = strcmp(path, "-") == 0;
    FILE *file = standard ? stdin : fopen(path, "rb");
    if (!file)
        return iso_fail(ISO_UNREADABLE, "%s: can't be opened: %s", path, strerror(errno));
    iso_status status = ISO_OK;
    int64_t capacity = 0;
    size_t got = 1;
    while (status == ISO_OK && got > 0) {
        status = ISO_GROW(text->bytes, capacity, text->size + 65537);
        if (status != ISO_OK)
            break;
        got = fread(text->bytes + text->size, 1, (size_t)capacity - text->size - 1, file);
        text->size += got;
        text->bytes[text->size] = '\0';
    }
    if (status == ISO_OK && ferror(file))
        status = iso_fail(ISO_UNREADABLE, "%s: can't be read: %s", path, strerror(errno));
    if (!standard)
        fclose(file);
    if (status != ISO_OK)
        iso_preview_text_free(text);
    return status;
}

void iso_preview_text_free(iso_preview_text *text) {
    iso_release(text->bytes);
    *text = (iso_preview_text){0};
}

/* A decimal number whatever the locale says; NULL if there is none. */
static const char *read_number(double *value, const char *at) {
    bool negative = *at == '-';
    if (*at == '-' || *at == '+')
        at++;
    double mantissa = 0, scale = 1;
    bool digits = false, point = false;
    for (; (*at >= '0' && *at <= '9') || (*at == '.' && !point); at++) {
        if (*at == '.') {
            point = true;
            continue;
        }
        digits = true;
        if (point && scale >= 1e15)
            continue;
        mantissa = mantissa * 10 + (*at - '0');
        scale *= point ? 10 : 1;
    }
    *value = (negative ? -mantissa : mantissa) / scale;
    return digits ? at : NULL;
}

/* The words of one line that we look at. */
enum { G, M, X, Y, Z, E, I, J, R, WORDS };

typedef struct line_words {
    bool has[WORDS];
    double value[WORDS];
} line_words;

static const char *read_words(line_words *words, const char *at) {
    static const char letters[] = "GMXYZEIJR";
    *words = (line_words){0};
    while (*at && *at != '\n' && *at != ';') {
        char letter = *at++;
        letter = letter >= 'a' && letter <= 'z' ? (char)(letter - 32) : letter;
        const char *found = strchr(letters, letter);
        double value;
        const char *end = read_number(&value, at);
        if (!end)
            end = at;
        else if (found) {
            words->has[found - letters] = true;
            words->value[found - letters] = value;
        }
        /* M117 Hello G1: the text of a message is no move */
        if (letter == 'M' && words->has[M] && (words->value[M] == 117 || words->value[M] == 118))
            end += strcspn(end, "\n;");
        at = end;
    }
    return at;
}

typedef struct machine {
    const iso_preview_text *text;
    int64_t line;
    double position[4]; /* X Y Z E */
    bool relative, relative_e;
    bool marked; /* layers begin at ;LAYER_CHANGE */
    double filament_section;
    double width, height;  /* of the last comment; 0 none */
    double bead_z, step_z; /* z of the last bead and its distance to the z before */
    int32_t layer;
    uint8_t role;
    iso_preview_visit *visit;
    void *payload;
} machine;

static bool starts_with(const char *at, const char *start) {
    return strncmp(at, start, strlen(start)) == 0;
}

static uint8_t role_of(const char *name) {
    size_t length = strcspn(name, "\r\n");
    for (int role = 0; role < ISO_ROLE_COUNT; role++) {
        const char *known = iso_role_name((iso_role)role);
        if (strlen(known) == length && memcmp(known, name, length) == 0)
            return (uint8_t)role;
    }
    return ISO_ROLE_CUSTOM;
}

static void read_comment(machine *m, const char *at) {
    if (starts_with(at, ";TYPE:"))
        m->role = role_of(at + 6);
    else if (starts_with(at, ";WIDTH:"))
        (void)read_number(&m->width, at + 7);
    else if (starts_with(at, ";HEIGHT:"))
        (void)read_number(&m->height, at + 8);
    else if (m->marked && starts_with(at, ";LAYER_CHANGE"))
        m->layer++;
}

/* A stadium of area A and height h is A / h - pi h / 4 + h wide. */
static double width_of(const machine *m, double extruded, double length) {
    if (m->width > 0)
        return m->width;
    double height = m->height > 0 ? m->height : m->step_z > 0 ? m->step_z : 0.2;
    double width = extruded * m->filament_section / (length * height) + height * (1 - PI / 4);
    return width > height ? width : height;
}

static void enter_bead(machine *m, double z) {
    if (z == m->bead_z)
        return;
    m->step_z = z - (m->bead_z > 0 ? m->bead_z : 0);
    m->bead_z = z;
    if (!m->marked)
        m->layer++;
}

static double distance(iso_vec2 a, iso_vec2 b) {
    double dx = b.x - a.x, dy = b.y - a.y;
    return sqrt(dx * dx + dy * dy);
}

static iso_status beyond(const machine *m, const char *what) {
    return iso_fail(ISO_UNREADABLE, "%s:%lld: %s is beyond what a printer can do", m->text->path,
                    (long long)m->line, what);
}

/* A full circle as two halves: an arc between equal points is no arc to SVG. */
static iso_status visit_halves(machine *m, iso_preview_move *move) {
    if (!move->turn || distance(move->from, move->to) > 0)
        return m->visit(m->payload, move);
    iso_vec2 end = move->to;
    double end_z = move->z;
    move->to = (iso_vec2){2 * move->centre.x - end.x, 2 * move->centre.y - end.y};
    move->z = (move->from_z + end_z) / 2;
    ISO_TRY(m->visit(m->payload, move));
    move->from = move->to;
    move->from_z = move->z;
    move->to = end;
    move->z = end_z;
    return m->visit(m->payload, move);
}

static iso_status go_to(machine *m, const line_words *words) {
    static const int axis[4] = {X, Y, Z, E};
    double to[4];
    for (int k = 0; k < 4; k++) {
        bool relative = k == 3 ? m->relative_e : m->relative;
        to[k] = m->position[k];
        if (words->has[axis[k]])
            to[k] = words->value[axis[k]] + (relative ? m->position[k] : 0);
        if (k < 3 && !(to[k] >= -LONGEST_AXIS && to[k] <= LONGEST_AXIS))
            return beyond(m, k == 0 ? "X" : k == 1 ? "Y" : "Z");
    }
    iso_preview_move move = {.from = {m->position[0], m->position[1]},
                             .to = {to[0], to[1]},
                             .from_z = m->position[2],
                             .z = to[2],
                             .role = m->role};
    double extruded = to[3] - m->position[3];
    double length = distance(move.from, move.to);
    if (words->value[G] >= 2) {
        move.turn = words->value[G] == 2 ? -1 : 1;
        move.centre = (iso_vec2){move.from.x + words->value[I], move.from.y + words->value[J]};
        if (!(distance(move.from, move.centre) <= LONGEST_AXIS))
            return beyond(m, "the radius");
        if (length == 0)
            length = 2 * PI * distance(move.from, move.centre);
    }
    memcpy(m->position, to, sizeof to);
    if (length == 0)
        return ISO_OK;
    if (extruded > 0) {
        enter_bead(m, to[2]);
        move.width = width_of(m, extruded, length);
        move.height = m->height;
        if (!(move.width <= WIDEST_BEAD))
            return beyond(m, "the width of the bead");
    }
    move.layer = m->layer;
    return visit_halves(m, &move);
}

static iso_status obey(machine *m, const line_words *words) {
    static const int axis[4] = {X, Y, Z, E};
    double code = words->value[G];
    if (words->has[M] && (words->value[M] == 82 || words->value[M] == 83))
        m->relative_e = words->value[M] == 83;
    if (!words->has[G])
        return ISO_OK;
    if ((code == 2 || code == 3) && words->has[R])
        return iso_fail(ISO_UNREADABLE, "%s:%lld: arcs by radius can't be drawn; write I and J",
                        m->text->path, (long long)m->line);
    if (code >= 0 && code <= 3)
        return go_to(m, words);
    if (code == 90 || code == 91) /* E too, as Marlin has it */
        m->relative = m->relative_e = code == 91;
    bool none = !words->has[X] && !words->has[Y] && !words->has[Z] && !words->has[E];
    for (int k = 0; k < 4 && (code == 28 || code == 92); k++)
        if ((none && (code == 92 || k < 3)) || words->has[axis[k]])
            m->position[k] = code == 92 ? words->value[axis[k]] : 0;
    return ISO_OK;
}

iso_status iso_preview_read(int32_t *layers, const iso_preview_text *text, double filament_diameter,
                            iso_preview_visit *visit, void *payload) {
    machine m = {.text = text,
                 .filament_section = PI / 4 * filament_diameter * filament_diameter,
                 .bead_z = -LONGEST_AXIS - 1,
                 .layer = -1,
                 .role = ISO_ROLE_CUSTOM,
                 .visit = visit,
                 .payload = payload};
    m.marked = strstr(text->bytes, "\n;LAYER_CHANGE") || starts_with(text->bytes, ";LAYER_CHANGE");
    for (const char *at = text->bytes; *at; at += *at == '\n') {
        line_words words;
        m.line++;
        at = read_words(&words, at);
        ISO_TRY(obey(&m, &words));
        if (*at == ';')
            read_comment(&m, at);
        at += strcspn(at, "\n");
    }
    *layers = m.layer + 1;
    return ISO_OK;
}
