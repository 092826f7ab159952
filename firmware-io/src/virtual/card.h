/* An SD card in memory: files one behind the other, the one being written at the end. */
#ifndef FIO_VIRTUAL_CARD_H
#define FIO_VIRTUAL_CARD_H

#include <stdbool.h>
#include <stddef.h>

enum { FIO_CARD_FILES = 16, FIO_CARD_BYTES = 1 << 18, FIO_CARD_NAME = 32 };

typedef struct fio_card_file {
    char name[FIO_CARD_NAME];
    int start, size;
} fio_card_file;

typedef struct fio_card {
    bool released, saving, printing;
    int count, used; /* files, bytes */
    int open;        /* index of the file selected or being written; -1 */
    int position;    /* in the selected file */
    bool full;       /* something could not be written */
    fio_card_file files[FIO_CARD_FILES];
    char bytes[FIO_CARD_BYTES];
} fio_card;

int fio_card_find(const fio_card *card, const char *name); /* -1 */
bool fio_card_select(fio_card *card, const char *name);
/* Begin to write; an old file of this name goes. False: no room for another. */
bool fio_card_create(fio_card *card, const char *name);
bool fio_card_write(fio_card *card, const char *bytes, size_t size);
void fio_card_close(fio_card *card);
bool fio_card_delete(fio_card *card, const char *name);
/* The next byte of the file being printed; -1 at its end. */
int fio_card_next(fio_card *card);

#endif
