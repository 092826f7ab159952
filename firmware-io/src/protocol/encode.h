/* Commands as they go over the wire: numbered, with a checksum, and so that no single flipped bit
 * makes a firmware execute anything else than what was meant.
 *
 * Written for how Marlin (and what descends from Sprinter like it) reads: a line ends with LF or
 * CR, `;` starts a comment, a backslash is dropped and the byte behind it taken as it is, a
 * backspace takes the byte before it away, and the checksum is behind the last '*'. */
#ifndef FIO_PROTOCOL_ENCODE_H
#define FIO_PROTOCOL_ENCODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

enum { FIO_WIRE_LINE_MOST = 255 }; /* bytes of a line on the wire, its end included */

/* Write "N<number> <command>*<checksum>\n" to `wire` (FIO_WIRE_LINE_MOST + 1 bytes, ends with a 0).
 * `command` has no end, no N; `number` >= 0. Returns the length, 0 if the line would be longer than
 * `most` bytes without its end (blanks between words are squeezed out first if that helps; the
 * texts of M117, M118, M0 and M1 are cut instead), or if the command is empty or holds a ';' or a
 * control byte. A backslash or a parenthesis, which such firmwares leave out, is sent as '/' or a
 * bracket.
 *
 * A byte that is not the line's end can only be damaged so that the checksum tells. Where the end
 * is damaged, the firmware sees two lines as one, "N5 a*33?N6 b*44", and takes it for line 5 if
 * 33 ^ '*' ^ '3' ^ '3' ^ '?' happens to be 0: a blank before the '*' or a zero before the number
 * changes the sum, and is put there where any one flipped bit of the end would do harm. In texts
 * that are only shown, what a bit could turn into the start of a command is written a little
 * differently: "J G28" as "j G28". See encode.c for the proof, and for what remains. */
size_t fio_encode_line(char *wire, int64_t number, const char *command, size_t length, size_t most);

/* A firmware with an emergency parser obeys M108, M112, M410 and M876 in whatever it receives, with
 * no look at the checksum: one bit makes M400 an M410 that throws moves away. "M0400" is the same
 * command, but no single bit makes an emergency of it. Writes the command so if that is needed,
 * else as it is. `text` has room for length + 3 bytes and ends with a 0; returns its length. */
size_t fio_encode_disguised(char *text, const char *command, size_t length);

/* XOR of the bytes. */
unsigned fio_checksum(const char *bytes, size_t size);

#endif
