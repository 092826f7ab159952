/* MeatPack as the firmware unpacks it: two of the 15 commonest characters in a byte. */
#ifndef FIO_VIRTUAL_MEATPACK_H
#define FIO_VIRTUAL_MEATPACK_H

#include <stdbool.h>
#include <stdint.h>

typedef struct fio_unpacker {
    bool on, no_spaces;
    bool commanded; /* two signal bytes came: the next one is a command */
    int signals;    /* signal bytes seen in a row */
    int literals;   /* whole characters that follow */
    char second;    /* comes after the first of them; 0: none */
} fio_unpacker;

/* One byte in, at most four characters out; returns how many. *told: a command came, and the state
 * has to be reported. */
int fio_unpacker_feed(fio_unpacker *unpacker, uint8_t byte, char text[4], bool *told);

#endif
