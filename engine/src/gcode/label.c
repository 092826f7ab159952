#include "gcode/label.h"

#include "gcode/number.h"

enum { NAME_MOST = 200 };

iso_status iso_labels_check(const iso_gcode_options *o) {
    const iso_flavour_words *words = iso_flavour_get_words(o->flavour);
    if (o->labels == ISO_LABELS_FIRMWARE && words->labels == ISO_LABELS_UNSPOKEN)
        return iso_fail(ISO_BAD_CONFIG,
                        "gcode_label_objects: %s has no commands for objects; use octoprint",
                        words->name);
    return ISO_OK;
}

static int is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/* In comments as it is but for ends of lines; in commands letters, digits and underscores. */
static char *put_name(char *p, const char *name, int in_command) {
    for (int i = 0; name && name[i] && i < NAME_MOST; i++) {
        char c = name[i];
        if ((unsigned char)c < ' ' || (in_command && !is_plain(c)))
            c = '_';
        *p++ = c;
    }
    return p;
}

/* As PrusaSlicer tells copies apart. */
static char *put_klipper_name(char *p, const iso_gcode_object *object) {
    p = ISO_PUT(put_name(p, object->name, 1), "_id_");
    p = ISO_PUT(iso_put_integer(p, object->model), "_copy_");
    return iso_put_integer(p, object->copy);
}

static char *put_place(char *p, iso_vec2 at) {
    p = iso_put_decimal(p, (int64_t)(at.x * 1000 + (at.x < 0 ? -0.5 : 0.5)), 3);
    *p++ = ',';
    return iso_put_decimal(p, (int64_t)(at.y * 1000 + (at.y < 0 ? -0.5 : 0.5)), 3);
}

static void define_for_klipper(iso_lines *lines, const iso_gcode_object *object) {
    char *p = ISO_PUT(iso_lines_reserve(lines), "EXCLUDE_OBJECT_DEFINE NAME=");
    p = ISO_PUT(put_klipper_name(p, object), " CENTER=");
    p = put_place(p, object->center);
    for (int32_t i = 0; i < object->outline_count; i++) {
        iso_lines_accept(lines, p);
        p = iso_lines_reserve(lines);
        p = i == 0 ? ISO_PUT(p, " POLYGON=[[") : ISO_PUT(p, ",[");
        p = put_place(p, object->outline[i]);
        *p++ = ']';
    }
    if (object->outline_count > 0)
        *p++ = ']';
    iso_lines_accept(lines, iso_put_newline(p));
}

static void define_for_duet(iso_lines *lines, const iso_gcode_object *object, int32_t index) {
    char *p = iso_put_integer(ISO_PUT(iso_lines_reserve(lines), "M486 S"), index);
    p = put_name(ISO_PUT(p, " A\""), object->name, 1);
    iso_lines_accept(lines, ISO_PUT(p, "\"\n"));
}

void iso_labels_define(iso_lines *lines, const iso_gcode_options *o) {
    iso_label_dialect dialect = iso_flavour_get_words(o->flavour)->labels;
    if (o->labels != ISO_LABELS_FIRMWARE || o->object_count == 0)
        return;
    if (dialect == ISO_LABELS_MARLIN) {
        char *p = iso_put_integer(ISO_PUT(iso_lines_reserve(lines), "M486 T"), o->object_count);
        iso_lines_accept(lines, iso_put_newline(p));
    }
    for (int32_t i = 0; i < o->object_count; i++)
        if (dialect == ISO_LABELS_KLIPPER)
            define_for_klipper(lines, &o->object[i]);
        else if (dialect == ISO_LABELS_DUET)
            define_for_duet(lines, &o->object[i], i);
    if (dialect == ISO_LABELS_DUET)
        iso_lines_accept(lines, ISO_PUT(iso_lines_reserve(lines), "M486 S-1\n"));
}

static int is_labelled(const iso_gcode_options *o, int32_t object) {
    return o->labels != ISO_LABELS_DISABLED && object >= 0 && object < o->object_count;
}

static char *put_comment(char *p, const iso_gcode_object *object) {
    p = ISO_PUT(put_name(p, object->name, 0), " id:");
    p = ISO_PUT(iso_put_integer(p, object->model), " copy ");
    return iso_put_integer(p, object->copy);
}

void iso_labels_begin(iso_lines *lines, const iso_gcode_options *o, int32_t object) {
    if (!is_labelled(o, object))
        return;
    char *p = iso_lines_reserve(lines);
    if (o->labels == ISO_LABELS_OCTOPRINT)
        p = put_comment(ISO_PUT(p, "; printing object "), &o->object[object]);
    else if (iso_flavour_get_words(o->flavour)->labels == ISO_LABELS_KLIPPER)
        p = put_klipper_name(ISO_PUT(p, "EXCLUDE_OBJECT_START NAME="), &o->object[object]);
    else
        p = iso_put_integer(ISO_PUT(p, "M486 S"), object);
    iso_lines_accept(lines, iso_put_newline(p));
}

void iso_labels_end(iso_lines *lines, const iso_gcode_options *o, int32_t object) {
    if (!is_labelled(o, object))
        return;
    char *p = iso_lines_reserve(lines);
    if (o->labels == ISO_LABELS_OCTOPRINT)
        p = put_comment(ISO_PUT(p, "; stop printing object "), &o->object[object]);
    else if (iso_flavour_get_words(o->flavour)->labels == ISO_LABELS_KLIPPER)
        p = put_klipper_name(ISO_PUT(p, "EXCLUDE_OBJECT_END NAME="), &o->object[object]);
    else
        p = ISO_PUT(p, "M486 S-1");
    iso_lines_accept(lines, iso_put_newline(p));
}
