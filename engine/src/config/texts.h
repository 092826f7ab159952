/* The G-code texts of a job: what is known of it, and the variables that outlive a text. */
#ifndef ISO_CONFIG_TEXTS_H
#define ISO_CONFIG_TEXTS_H

#include <isoslice/gcode.h>
#include <isoslice/planar.h>

#include "macro/macro.h"

/* Zero-initialise; must not move once begun. */
typedef struct iso_texts {
    const iso_options *options;
    iso_macro_job job;
    iso_vec2 *hull; /* the job's */
    iso_macro_globals globals;
    iso_macro_scope scope;
} iso_texts;

/* Texts of these options, which must outlive them. With a job, whose input's name and hull must do
 * so, too, its values have names; NULL: they are unknown. */
void texts_begin(iso_texts *texts, const iso_options *options, const iso_macro_job *job);
void texts_free(iso_texts *texts);

/* Where the first layer comes to lie: these contours, widened by skirt and brim. The hull belongs
 * to the texts. */
iso_status texts_place(iso_texts *texts, const iso_region *first) ISO_MUST_CHECK;

/* See that all texts are right before anything is written: expanded as at the first layer (the end:
 * at the last one, whose top is at `top` mm), or by their form alone if one of them sets a global
 * variable, since that can't be done twice. ISO_BAD_CONFIG. */
iso_status texts_check(const iso_texts *texts, double top) ISO_MUST_CHECK;

/* An iso_gcode_text; the payload is an iso_texts. One at a time, since variables may change. */
iso_status texts_write(char *text, size_t size, const void *payload, iso_gcode_text_kind kind,
                       const iso_gcode_place *place) ISO_MUST_CHECK;

/* Any other text, called `name` in messages. */
iso_status texts_expand(char *text, size_t size, const iso_texts *texts, const char *from,
                        const char *name) ISO_MUST_CHECK;

#endif
