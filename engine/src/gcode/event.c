#include "gcode/event.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define LEVEL 1e-4 /* mm: tops nearer than this are the same height */

void iso_events_free(iso_events *events) {
    iso_release(events->event);
    iso_release(events->text);
    *events = (iso_events){0};
}

/* In place by height; those of one height keep their order. Lists are short. */
static void insert(iso_events *events, iso_event event) {
    int32_t i = events->count++;
    for (; i > 0 && events->event[i - 1].z > event.z; i--)
        events->event[i] = events->event[i - 1];
    events->event[i] = event;
}

/* Does the word begin the action, and nothing but a space or the end follow? Then the rest. */
static const char *after_word(const char *action, const char *word) {
    size_t size = strlen(word);
    if (strncmp(action, word, size) != 0 || (action[size] != ' ' && action[size] != '\0'))
        return NULL;
    return action + size + strspn(action + size, " ");
}

static iso_event event_of(double z, const char *action) {
    const char *rest;
    if ((rest = after_word(action, "color")) && !*rest)
        return (iso_event){z, ISO_TEXT_COLOR_CHANGE, NULL};
    if ((rest = after_word(action, "template")) && !*rest)
        return (iso_event){z, ISO_TEXT_TEMPLATE, NULL};
    if ((rest = after_word(action, "pause")))
        return (iso_event){z, ISO_TEXT_PAUSE, *rest ? rest : NULL};
    return (iso_event){z, ISO_TEXT_EVENT, action};
}

static void trim(char **from, char *end) {
    *from += strspn(*from, " \t\r");
    while (end > *from && strchr(" \t\r", end[-1]))
        end--;
    *end = '\0';
}

/* "HEIGHT:ACTION", terminated at `end`. */
static iso_status read_event(iso_events *events, char *item, char *end) {
    trim(&item, end);
    if (!*item)
        return ISO_OK;
    char *colon, *action;
    double z = strtod(item, &colon);
    colon += strspn(colon, " \t");
    if (colon == item || *colon != ':' || !(z >= 0 && z <= 1e5))
        return iso_fail(ISO_BAD_CONFIG,
                        "events: \"%s\" does not begin with a height in mm and a colon", item);
    action = colon + 1;
    trim(&action, action + strlen(action));
    if (!*action)
        return iso_fail(ISO_BAD_CONFIG,
                        "events: nothing is said to happen at %g mm; it may be color, pause, "
                        "template or any G-code",
                        z);
    insert(events, event_of(z, action));
    return ISO_OK;
}

static iso_status read_all(iso_events *events, const iso_gcode_options *o) {
    for (int32_t i = 0; i < o->colorprint_count; i++)
        insert(events, (iso_event){o->colorprint_height[i], ISO_TEXT_COLOR_CHANGE, NULL});
    for (char *item = events->text, *end; *item; item = end) {
        end = item + strcspn(item, ";\n");
        char *next = *end ? end + 1 : end;
        ISO_TRY(read_event(events, item, end));
        end = next;
    }
    return ISO_OK;
}

iso_status iso_events_new(iso_events *events, const iso_gcode_options *o) {
    const char *text = o->events ? o->events : "";
    int64_t size = (int64_t)strlen(text) + 1, most = o->colorprint_count + 1;
    *events = (iso_events){0};
    for (const char *c = text; *c; c++)
        most += *c == ';' || *c == '\n';
    iso_status status = ISO_ALLOCATE(events->event, most);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(events->text, size);
    if (status == ISO_OK) {
        memcpy(events->text, text, (size_t)size);
        status = read_all(events, o);
    }
    if (status != ISO_OK)
        iso_events_free(events);
    return status;
}

const iso_event *iso_events_take(iso_events *events, double z) {
    if (events->next == events->count || events->event[events->next].z > z + LEVEL)
        return NULL;
    return &events->event[events->next++];
}
