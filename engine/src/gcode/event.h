/* What happens at which heights: changes of the filament, pauses, the user's own G-code. */
#ifndef ISO_GCODE_EVENT_H
#define ISO_GCODE_EVENT_H

#include <isoslice/gcode.h>

typedef struct iso_event {
    double z;                 /* mm; it comes before the first layer whose top is as high */
    iso_gcode_text_kind kind; /* ISO_TEXT_COLOR_CHANGE, _PAUSE, _TEMPLATE, or _KIND_COUNT: own */
    const char *text;         /* own G-code, or a pause's message; NULL: none */
} iso_event;

typedef struct iso_events {
    int32_t count, next; /* next: of those that are to come */
    iso_event *event;    /* by height */
    char *text;          /* what their texts point into */
} iso_events;

/* Both lists of the options. ISO_BAD_CONFIG names what can't be read. */
iso_status iso_events_new(iso_events *events, const iso_gcode_options *options) ISO_MUST_CHECK;
void iso_events_free(iso_events *events);

/* The next one that comes before a layer of that top, or NULL. */
const iso_event *iso_events_take(iso_events *events, double z);

#endif
