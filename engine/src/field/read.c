/* Fields from the texts of users. */
#include "field/field.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/angle.h"
#include "base/vector.h"
#include "field/number.h"

enum { NUMBERS = 4 };

/* The smallest of lengths that are divided by, mm; and the largest number of any kind. */
static const double least_length = 0.001, largest = 1e6;

typedef struct text {
    const char *text, *at;
} text;

typedef struct arguments {
    int axis; /* 0, 1, 2: x, y, z */
    int count;
    double number[NUMBERS];
    int column[NUMBERS];
} arguments;

/* ---- messages ---- */

static iso_status expected(const text *t, const char *what) {
    unsigned char c = (unsigned char)*t->at;
    int column = (int)(t->at - t->text) + 1;
    if (c == 0)
        return iso_fail(ISO_BAD_CONFIG, "column %d: expected %s, not the end", column, what);
    if (c >= ' ' && c < 127)
        return iso_fail(ISO_BAD_CONFIG, "column %d: expected %s, not '%c'", column, what, c);
    return iso_fail(ISO_BAD_CONFIG, "column %d: expected %s, not a byte %d", column, what, c);
}

static iso_status out_of_range(const arguments *from, int which, const char *what) {
    return iso_fail(ISO_BAD_CONFIG, "column %d: %s", from->column[which], what);
}

/* ---- kinds ---- */

static const iso_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static iso_status read_plane(field_numbers *to, const arguments *from) {
    iso_vec3 normal = {from->number[0], from->number[1], from->number[2]};
    double largest_part = fmax(fabs(normal.x), fmax(fabs(normal.y), fabs(normal.z)));
    if (largest_part == 0)
        return out_of_range(from, 0, "a plane needs a direction other than 0,0,0");
    to->shape.axis = vec3_unit(vec3_times(normal, 1 / largest_part));
    return ISO_OK;
}

/* The two coordinates across the axis, in the order of x, y, z. */
static iso_vec3 point_of_axis(const arguments *from) {
    double a = from->number[0], b = from->number[1];
    return from->axis == 0 ? vec3(0, a, b) : from->axis == 1 ? vec3(a, 0, b) : vec3(a, b, 0);
}

/* Around an axis that lies angles begin at the top. */
static iso_status read_cylinder(field_numbers *to, const arguments *from) {
    to->shape.axis = unit[from->axis];
    to->shape.from = unit[from->axis == 2 ? 0 : 2];
    to->shape.center = point_of_axis(from);
    return ISO_OK;
}

static iso_status read_cone(field_numbers *to, const arguments *from) {
    double sine, cosine;
    if (!(fabs(from->number[0]) <= 89))
        return out_of_range(from, 0, "the slope of a cone is -89 to 89 degrees");
    iso_sine_cosine(&sine, &cosine, from->number[0]);
    to->shape.slope = sine / cosine;
    to->shape.center = vec3(from->number[1], from->number[2], 0);
    return ISO_OK;
}

static iso_status read_sphere(field_numbers *to, const arguments *from) {
    to->shape.center = vec3(from->number[0], from->number[1], from->number[2]);
    return ISO_OK;
}

static iso_status read_torus(field_numbers *to, const arguments *from) {
    if (!(from->number[0] >= least_length))
        return out_of_range(from, 0, "the radius of a torus is 0.001 mm at least");
    to->shape.radius = from->number[0];
    to->shape.center = vec3(from->number[1], from->number[2], from->number[3]);
    return ISO_OK;
}

static iso_status read_wave(field_numbers *to, const arguments *from) {
    if (!(from->number[1] >= least_length))
        return out_of_range(from, 1, "the length of a wave is 0.001 mm at least");
    to->amplitude = from->number[0];
    to->length = from->number[1];
    to->direction = from->number[2];
    return ISO_OK;
}

/* Angles begin level, on the axis's positive side or, for a radius below 0, on the other one, and
 * rise upwards; around an upright axis, from x towards y. */
static iso_status read_fan(field_numbers *to, const arguments *from) {
    double radius = from->number[2];
    if (!(fabs(radius) >= least_length))
        return out_of_range(from, 2, "the radius of a fan is 0.001 mm at least, or -0.001 at most");
    iso_vec3 side = unit[from->axis == 0 ? 1 : 0], up = unit[from->axis == 2 ? 1 : 2];
    to->shape.from = vec3_times(side, radius < 0 ? -1 : 1);
    to->shape.axis = vec3_cross(to->shape.from, up);
    to->shape.radius = fabs(radius);
    to->shape.center = point_of_axis(from);
    return ISO_OK;
}

static const struct {
    const char *name, *usage;
    iso_field_kind kind;
    int has_axis, least, most;
    iso_status (*read)(field_numbers *to, const arguments *from);
} kinds[] = {
    {"plane", "plane:nx,ny,nz", ISO_FIELD_PLANE, 0, 3, 3, read_plane},
    {"cylinder", "cylinder:AXIS[,c,c]", ISO_FIELD_CYLINDER, 1, 0, 2, read_cylinder},
    {"cone", "cone:SLOPE[,x,y]", ISO_FIELD_CONE, 0, 1, 3, read_cone},
    {"sphere", "sphere:x,y,z", ISO_FIELD_SPHERE, 0, 3, 3, read_sphere},
    {"torus", "torus:R[,x,y,z]", ISO_FIELD_TORUS, 0, 1, 4, read_torus},
    {"wave", "wave:AMPLITUDE,LENGTH[,DIRECTION]", ISO_FIELD_WAVE, 0, 2, 3, read_wave},
    {"fan", "fan:AXIS,c,c,R", ISO_FIELD_FAN, 1, 3, 3, read_fan},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* ---- reading ---- */

static void skip_blanks(text *t) {
    while (*t->at == ' ' || *t->at == '\t' || *t->at == '\n' || *t->at == '\r')
        t->at++;
}

static iso_status read_number(arguments *to, text *t) {
    to->column[to->count] = (int)(t->at - t->text) + 1;
    bool negative = *t->at == '-';
    t->at += *t->at == '-' || *t->at == '+';
    if (!number_begins(t->at))
        return expected(t, "a number");
    double number;
    if (!number_read(&number, &t->at))
        return expected(t, "digits of the exponent");
    if (!(number <= largest))
        return out_of_range(to, to->count, "numbers go up to 1000000");
    to->number[to->count++] = negative ? -number : number;
    skip_blanks(t);
    return ISO_OK;
}

static iso_status read_axis(arguments *to, text *t) {
    if (*t->at < 'x' || *t->at > 'z')
        return expected(t, "an axis: x, y or z");
    to->axis = *t->at++ - 'x';
    skip_blanks(t);
    return ISO_OK;
}

/* Behind the colon, to the end. What may be left out is left out as a whole. */
static iso_status read_arguments(arguments *to, text *t, int kind) {
    char what[80];
    bool more = true;
    skip_blanks(t);
    if (kinds[kind].has_axis) {
        ISO_TRY(read_axis(to, t));
        more = *t->at == ',';
        t->at += more;
        skip_blanks(t);
    }
    while (more && to->count < kinds[kind].most) {
        ISO_TRY(read_number(to, t));
        more = *t->at == ',';
        t->at += more;
        skip_blanks(t);
    }
    if (*t->at == 0 && !more && (to->count == kinds[kind].least || to->count == kinds[kind].most))
        return ISO_OK;
    if (more)
        t->at -= to->count == kinds[kind].most; /* one comma too many */
    snprintf(what, sizeof what, "%s as in %s", *t->at == 0 ? "',' and a number" : "',' or the end",
             kinds[kind].usage);
    return expected(t, what);
}

static iso_status unknown_kind(const text *t, int length) {
    char names[100];
    int used = 0;
    for (int i = 0; i < KINDS; i++)
        used += snprintf(names + used, sizeof names - (size_t)used, "%s%s", i > 0 ? ", " : "",
                         kinds[i].name);
    return iso_fail(ISO_BAD_CONFIG, "column %d: there is no field '%.*s:'; there are %s",
                    (int)(t->at - t->text) + 1, length < 40 ? length : 40, t->at, names);
}

/* The length of a name with a colon behind it; 0: none is there, so this is an expression. */
static int name_length(const char *at) {
    int length = 0;
    while ((at[length] >= 'a' && at[length] <= 'z') || (at[length] >= 'A' && at[length] <= 'Z') ||
           at[length] == '-' || at[length] == '_')
        length++;
    return at[length] == ':' ? length : 0;
}

iso_status iso_field_new(iso_field **field, const char *string) {
    text t = {string, string};
    *field = NULL;
    skip_blanks(&t);
    int length = name_length(t.at), kind = 0;
    if (length == 0)
        return field_new_expression(field, string);
    while (kind < KINDS && (strlen(kinds[kind].name) != (size_t)length ||
                            memcmp(kinds[kind].name, t.at, (size_t)length) != 0))
        kind++;
    if (kind == KINDS)
        return unknown_kind(&t, length);
    t.at += length + 1;
    arguments from = {0};
    field_numbers numbers = {.shape = {.axis = {0, 0, 1}, .from = {1, 0, 0}}};
    ISO_TRY(read_arguments(&from, &t, kind));
    ISO_TRY(kinds[kind].read(&numbers, &from));
    return field_new_shape(field, kinds[kind].kind, &numbers);
}
