#include "moves.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct reader {
    moves *out;
    const machine *machine;
    double x, y, z, e, angle[2];
    double drawn; /* mm of filament that are drawn back */
    double height, printed_z;
    bool relative, relative_e, named_layers;
    int32_t layer, line;
} reader;

int machine_named(machine *m, const char *kinematics) {
    static const struct {
        const char *name;
        int tilt, around;
        char letter[2];
    } known[] = {{"cartesian", -1, -1, {0, 0}},
                 {"rotary_a", 0, -1, {'A', 0}},
                 {"rotary_b", 1, -1, {'B', 0}},
                 {"table_ac", 0, 2, {'A', 'C'}},
                 {"table_bc", 1, 2, {'B', 'C'}}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i].name, kinematics) == 0) {
            m->tilt = known[i].tilt, m->around = known[i].around;
            memcpy(m->letter, known[i].letter, sizeof m->letter);
            return 1;
        }
    return 0;
}

turn machine_turn(const machine *m, const double angle[2]) {
    turn r = turn_about(2, 0);
    if (m->around >= 0)
        r = turn_about(m->around, angle[1]);
    if (m->tilt >= 0)
        r = turn_after(turn_about(m->tilt, angle[0]), r);
    return r;
}

static vec place(const machine *m, vec at, const double angle[2]) {
    return plus(m->pivot, turned_back(machine_turn(m, angle), minus(at, m->pivot)));
}

static void add(moves *m, const move *one) {
    if (m->count == m->capacity) {
        m->capacity = m->capacity ? 2 * m->capacity : 4096;
        m->at = realloc(m->at, (size_t)m->capacity * sizeof *m->at);
        if (!m->at)
            abort();
    }
    m->at[m->count++] = *one;
}

/* Axes go evenly from one end of a move to the other: the tip's way over a part that turns
 * meanwhile is none too straight, and is cut up. */
static void go(reader *r, vec to, const double angle[2], double pushed) {
    vec from = {r->x, r->y, r->z};
    double turns = fmax(fabs(angle[0] - r->angle[0]), fabs(angle[1] - r->angle[1]));
    int pieces = 1 + (int)(turns / 0.5);
    double volume = 0, section = PI / 4 * r->machine->filament * r->machine->filament;
    bool moved = length(minus(to, from)) > 1e-7 || turns > 1e-7;
    if (pushed < 0) {
        r->drawn -= pushed;
    } else if (pushed > 0) {
        double back = fmin(pushed, r->drawn);
        r->drawn -= back;
        volume = (pushed - back) * section;
        if (!moved)
            r->out->lost += volume;
    }
    if (volume > 0 && moved && !r->named_layers && fabs(to.z - r->printed_z) > 1e-4)
        r->layer++, r->printed_z = to.z;
    if (r->layer + 1 > r->out->layers)
        r->out->layers = r->layer + 1;
    move one = {.height = r->height, .layer = r->layer, .line = r->line};
    for (int i = 0; i < pieces && moved; i++) {
        double ends[2] = {(double)i / pieces, (double)(i + 1) / pieces};
        for (int k = 0; k < 2; k++) {
            one.before[k] = r->angle[k] + ends[0] * (angle[k] - r->angle[k]);
            one.angle[k] = r->angle[k] + ends[1] * (angle[k] - r->angle[k]);
        }
        one.from = place(r->machine, mix(from, to, ends[0]), one.before);
        one.to = place(r->machine, mix(from, to, ends[1]), one.angle);
        one.volume = volume / pieces;
        add(r->out, &one);
    }
    r->x = to.x, r->y = to.y, r->z = to.z;
    r->angle[0] = angle[0], r->angle[1] = angle[1];
}

static void comment(reader *r, const char *text) {
    if (strncmp(text, ";LAYER_CHANGE", 13) == 0)
        r->layer = r->named_layers ? r->layer + 1 : 0, r->named_layers = true;
    if (strncmp(text, ";HEIGHT:", 8) == 0)
        r->height = atof(text + 8);
}

/* Words of a line by letter; *has has their bits. */
static void words(double value[26], uint32_t *has, char *text) {
    *has = 0;
    for (char *p = text; *p && *p != ';' && *p != '\n';) {
        int k = toupper((unsigned char)*p++) - 'A';
        if (k < 0 || k >= 26)
            continue;
        char *end;
        double v = strtod(p, &end);
        value[k] = end == p ? 0 : v;
        if (!(*has >> k & 1))
            *has |= 1u << k;
        p = end;
        if (k == 'M' - 'A' && v != 82 && v != 83)
            return;
    }
}

static double word(const double value[26], uint32_t has, int letter, double now, bool relative) {
    int k = letter - 'A';
    return letter && has >> k & 1 ? value[k] + (relative ? now : 0) : now;
}

static int command(reader *r, const double v[26], uint32_t has) {
    bool g_given = has >> ('G' - 'A') & 1;
    int g = g_given ? (int)v['G' - 'A'] : -1, m = has >> ('M' - 'A') & 1 ? (int)v['M' - 'A'] : -1;
    if (m == 82 || m == 83)
        r->relative_e = m == 83;
    if (g == 90 || g == 91)
        r->relative = r->relative_e = g == 91;
    if (g == 28) /* start and end may home; what matters comes between and says where it goes */
        r->x = r->y = r->z = r->angle[0] = r->angle[1] = 0;
    if (g == 2 || g == 3 || g == 20) {
        fprintf(stderr, "line %d: G%d is beyond this reader\n", r->line, g);
        return 0;
    }
    if (g != 0 && g != 1 && g != 92)
        return 1;
    const char *letter = r->machine->letter;
    bool add_now = r->relative && g != 92;
    vec to = {word(v, has, 'X', r->x, add_now), word(v, has, 'Y', r->y, add_now),
              word(v, has, 'Z', r->z, add_now)};
    double angle[2], e = word(v, has, 'E', r->e, r->relative_e && g != 92);
    for (int k = 0; k < 2; k++)
        angle[k] = word(v, has, letter[k], r->angle[k], add_now);
    if (g == 92) {
        r->x = to.x, r->y = to.y, r->z = to.z;
        r->angle[0] = angle[0], r->angle[1] = angle[1];
    } else {
        go(r, to, angle, e - r->e);
    }
    r->e = e;
    return 1;
}

int moves_read(moves *m, const char *path, const machine *on) {
    FILE *file = fopen(path, "r");
    if (!file) {
        perror(path);
        return 0;
    }
    *m = (moves){0};
    reader r = {.out = m, .machine = on, .printed_z = -1, .layer = -1};
    char text[8192];
    int good = 1;
    while (good && fgets(text, sizeof text, file)) {
        double value[26];
        uint32_t has;
        r.line++;
        comment(&r, text);
        words(value, &has, text);
        good = command(&r, value, has);
    }
    fclose(file);
    return good;
}
