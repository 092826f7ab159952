/* Words around the moves. */
#ifndef ISO_GCODE_TEXT_H
#define ISO_GCODE_TEXT_H

#include <stdint.h>

enum { ISO_DATE_SIZE = 40 };

/* "YYYY-MM-DD at HH:MM:SS", UTC, of seconds since 1970. */
void iso_text_date(char date[ISO_DATE_SIZE], int64_t timestamp);

/* "1d 2h 3m 4s", larger units only if they are needed, as PrusaSlicer writes it. Returns the end.
 */
char *iso_text_put_duration(char *to, int64_t seconds);

/* Is `command` (M104) among the commands of the text? Comments don't count. */
int iso_text_has_command(const char *text, const char *command);

#endif
