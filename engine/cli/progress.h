/* How far a job is, as one line of a terminal. */
#ifndef ISO_CLI_PROGRESS_H
#define ISO_CLI_PROGRESS_H

#include <stdbool.h>

/* Zero-initialise. */
typedef struct iso_progress {
    double drawn; /* seconds, when the line was drawn last */
    bool shown;
} iso_progress;

/* Draws over what was drawn before, twenty times a second at most; payload is an iso_progress. */
void iso_progress_draw(void *payload, double done, const char *stage);
void iso_progress_clear(const iso_progress *line);

#endif
