/* MeatPack packs a line's 15 commonest characters into half a byte each: Marlin and Prusa firmware
 * with that option unpack it before they read lines. */
#ifndef FIO_PROTOCOL_MEATPACK_H
#define FIO_PROTOCOL_MEATPACK_H

#include <stdbool.h>
#include <stddef.h>

typedef struct fio_meatpack {
    bool on;
    bool no_spaces; /* 'E' has the blank's half byte; a blank that occurs is sent whole */
} fio_meatpack;

/* Turn it on and set the alphabet. Each of the three returns the bytes written to `packed`: at most
 * 6 here and in fio_meatpack_end(). */
size_t fio_meatpack_begin(fio_meatpack *packer, bool no_spaces, unsigned char *packed);

/* `packed` has room for 2 * size + 8 bytes. Whole lines only: an odd number of characters is filled
 * up with a second line end, that of an empty line. A byte ff, which the format can't tell from a
 * command, becomes '?'. Off: copied as it is. */
size_t fio_meatpack_line(fio_meatpack *packer, const char *line, size_t size,
                         unsigned char *packed);

size_t fio_meatpack_end(fio_meatpack *packer, unsigned char *packed);

#endif
