/* Commands as they go over the wire: numbered, with a checksum, and so that no single flipped bit
 * can make two of them pass as one. */
#ifndef FIO_PROTOCOL_ENCODE_H
#define FIO_PROTOCOL_ENCODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

enum { FIO_WIRE_LINE_MOST = 255 }; /* bytes of a line on the wire, its end included */

/* Write "N<number> <command>*<checksum>\n" to `wire` (FIO_WIRE_LINE_MOST + 1 bytes, ends with a 0).
 * `command` has no comment, no end, no N. Returns the length, 0 if the line would be longer than
 * `most` bytes without its end (blanks between words are squeezed out first if that helps; the
 * texts of M117, M118 and the like are cut instead).
 *
 * Where the end of a line is damaged, the firmware sees two lines as one: "N5 a*33?N6 b*44". That
 * passes as line 5 if 33 ^ '*' ^ '3' ^ '3' ^ '?' happens to be 0. A blank before the '*' changes
 * the sum; the encoder puts one there where any one flipped bit of the line feed would do harm. */
size_t fio_encode_line(char *wire, int64_t number, const char *command, size_t length, size_t most);

/* XOR of the bytes. */
unsigned fio_checksum(const char *bytes, size_t size);

/* MeatPack packs a line's commonest 15 characters into half a byte each. `packed` has room for
 * 2 * size + 8 bytes; returns the bytes written. The stream is one: `packer` keeps the state. */
typedef struct fio_meatpack {
    bool on, no_spaces;
} fio_meatpack;

size_t fio_meatpack_begin(fio_meatpack *packer, bool no_spaces, unsigned char *packed);
size_t fio_meatpack_line(fio_meatpack *packer, const char *line, size_t size,
                         unsigned char *packed);
size_t fio_meatpack_end(fio_meatpack *packer, unsigned char *packed);

#endif
