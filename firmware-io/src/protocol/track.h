/* What the commands so far have set in the printer: enough to go on after a pause or a loss.
 *
 * Follows G0 to G3, G10, G11, G20, G21, G28, G90 to G92, M82, M83, M104, M106, M107, M109, M140,
 * M190, M204, M220, M221, T; everything else changes nothing. */
#ifndef FIO_PROTOCOL_TRACK_H
#define FIO_PROTOCOL_TRACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FIO_TRACK_TOOLS = 8 };

typedef struct fio_track {
    double position[4]; /* logical, mm */
    bool known[4];      /* given or homed since the start */
    bool homed;
    bool inches, relative, relative_extrusion;
    double feedrate; /* mm/min as in the file (mm even after G20); 0: none yet */
    double fan;      /* 0 … 255 */
    double nozzle[FIO_TRACK_TOOLS], bed; /* targets; -1: never set */
    int tool;
    double feedrate_percent, flow_percent;
    bool retracted; /* by G10 */
} fio_track;

void fio_track_reset(fio_track *track);
void fio_track_follow(fio_track *track, const char *command, size_t length);

/* Commands parted by '\n' that bring a printer from where it stands now to `track`: temperatures
 * first, homing x and y (never z onto a part) if `homing`, lift, move above, lower, prime, then
 * modes, feedrate, fan. Returns the length; `text` has room for FIO_TRACK_TEXT bytes and ends with
 * a 0. `lift` mm above the position on the way there. */
enum { FIO_TRACK_TEXT = 1024 };
size_t fio_track_restore(const fio_track *track, bool homing, double lift, double prime,
                         char *text);

#endif
