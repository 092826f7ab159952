/* What head.c and space.c share of the head: places in um, and the words of a move. */
#ifndef ISO_GCODE_HEAD_PARTS_H
#define ISO_GCODE_HEAD_PARTS_H

#include "gcode/head.h"
#include "gcode/number.h"

/* E is summed up in 2^-28 of its last digit (10 nm): what 10^7 moves round away stays below a tenth
 * of that digit, and 343 km of filament fit an int64. */
#define E_FRACTION 28

static inline int32_t to_micrometres(int32_t units) {
    return units < 0 ? (units - 5) / 10 : (units + 5) / 10;
}

static inline char *put_feed(iso_head *head, char *p, int32_t feed) {
    if (feed == head->feed)
        return p;
    head->feed = feed;
    head->speed = feed / 60.0;
    p = ISO_PUT(p, " F");
    return iso_put_integer(p, feed);
}

/* Move the filament by `delta` last digits. */
static inline char *put_e(iso_head *head, char *p, int64_t delta) {
    const char *axis = head->modes.words->axis;
    head->e += delta;
    if (!*axis)
        return p;
    p[0] = axis[0];
    p[1] = axis[1];
    return iso_put_hundred_thousandths(p + 2, head->relative_e ? delta : head->e);
}

/* The E that is due by now, but not yet emitted. */
static inline int64_t take_e(iso_head *head) {
    int64_t e = (head->drawn + ((int64_t)1 << (E_FRACTION - 1))) >> E_FRACTION;
    int64_t due = e - head->emitted;
    head->emitted = e;
    return due;
}

/* A move for the estimate, at the acceleration that holds, but no more than `most`. */
void head_plan(iso_head *head, const double delta[3], double length, double speed, int extrudes,
               double most);

void head_deretract(iso_head *head);
void head_blow(iso_head *head, int32_t role, const iso_layer_pace *pace);
/* What a piece of that role is printed with. */
void head_begin_piece(iso_head *head, int32_t role, const iso_layer_pace *pace);
const char *head_comment_of(int32_t role);

/* Units, of a bead where the layer is `local` units high. */
int32_t head_height_of(const iso_path_vertex *bead, int32_t local);

/* Tell the watch. Once it has failed it isn't asked again. */
void head_tell(iso_head *head, const iso_gcode_move *move);

#endif
