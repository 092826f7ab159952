/* What the commands so far have set in the printer: enough to go on after a pause or a loss.
 *
 * Follows G0 to G3, G10, G11, G20, G21, G28, G90 to G92, M18, M82 to M84, M104, M106, M107, M109,
 * M140, M190, M204, M220, M221, T; everything else changes nothing. Lengths are mm, also after G20.
 * Only what commands say is known: an axis is taken to stand at 0 after homing, which is right from
 * the first move on that names it. */
#ifndef FIO_PROTOCOL_TRACK_H
#define FIO_PROTOCOL_TRACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FIO_TRACK_TOOLS = 8 };

typedef struct fio_track {
    double position[4]; /* logical */
    double offset[3];   /* of G92: logical minus what the end stops see */
    bool known[4];      /* given or homed since the start */
    bool homed_axes[3]; /* and the motors held since */
    bool homed;         /* all three */
    bool inches, relative, relative_extrusion;
    double feedrate;                     /* mm/min; 0: none yet */
    double fan;                          /* 0 … 255 */
    double nozzle[FIO_TRACK_TOOLS], bed; /* targets; -1: never set */
    int tool;
    double feedrate_percent, flow_percent;
    double acceleration[3]; /* print, retract, travel, mm/s²; 0: never set */
    bool retracted;         /* by G10 */
    double raised; /* mm the nozzle stands above position[2], lifted by a pause or a cancel: for
                    * whoever lifted it to set; a move sets it to 0 */
} fio_track;

void fio_track_reset(fio_track *track);
void fio_track_follow(fio_track *track, const char *command, size_t length);

/* Commands parted by '\n' that bring a printer from where it stands now to `track`: temperatures
 * first, then `lift` mm up, above the position, down, `prime` mm of filament, then percentages,
 * feedrate, fan and at last units and modes. Returns the length; `text` has room for FIO_TRACK_TEXT
 * bytes and ends with a 0.
 *
 * `homing`: the firmware was reset and knows no position. It is told the height it stands at
 * (position[2] + raised, which must still be true), goes up, and homes x and y; never z, where the
 * part is. Nothing moves if the job had not homed yet: it will do that itself. Nothing is primed
 * unless the nozzle is to be 170 °C hot. */
enum { FIO_TRACK_TEXT = 1024 };
size_t fio_track_restore(const fio_track *track, bool homing, double lift, double prime,
                         char *text);

#endif
