#include "virtual/card.h"

#include <stdio.h>
#include <string.h>

int fio_card_find(const fio_card *card, const char *name) {
    for (int i = 0; i < card->count; i++)
        if (!strcmp(card->files[i].name, name))
            return i;
    return -1;
}

bool fio_card_select(fio_card *card, const char *name) {
    int found = card->released ? -1 : fio_card_find(card, name);
    if (found < 0 || card->saving)
        return false;
    card->open = found;
    card->position = 0;
    card->printing = false;
    return true;
}

static void remove_file(fio_card *card, int index) {
    fio_card_file gone = card->files[index];
    int behind = gone.start + gone.size;
    memmove(card->bytes + gone.start, card->bytes + behind, (size_t)(card->used - behind));
    card->used -= gone.size;
    card->count--;
    memmove(&card->files[index], &card->files[index + 1],
            (size_t)(card->count - index) * sizeof *card->files);
    for (int i = index; i < card->count; i++)
        card->files[i].start -= gone.size;
}

bool fio_card_delete(fio_card *card, const char *name) {
    int found = card->released ? -1 : fio_card_find(card, name);
    if (found < 0 || card->saving || (card->printing && card->open == found))
        return false;
    remove_file(card, found);
    if (card->open == found)
        card->open = -1;
    else if (card->open > found)
        card->open--;
    return true;
}

bool fio_card_create(fio_card *card, const char *name) {
    if (card->released || card->saving || card->printing || !*name || strlen(name) >= FIO_CARD_NAME)
        return false;
    int old = fio_card_find(card, name);
    if (old >= 0)
        remove_file(card, old);
    card->open = -1;
    if (card->count == FIO_CARD_FILES)
        return false;
    fio_card_file *file = &card->files[card->count];
    snprintf(file->name, sizeof file->name, "%s", name);
    file->start = card->used;
    file->size = 0;
    card->open = card->count++;
    card->saving = true;
    card->full = false;
    return true;
}

bool fio_card_write(fio_card *card, const char *bytes, size_t size) {
    if (!card->saving || size > (size_t)(FIO_CARD_BYTES - card->used)) {
        card->full = true;
        return false;
    }
    memcpy(card->bytes + card->used, bytes, size);
    card->used += (int)size;
    card->files[card->open].size += (int)size;
    return true;
}

void fio_card_close(fio_card *card) {
    card->saving = false;
    card->open = -1;
}

int fio_card_next(fio_card *card) {
    const fio_card_file *file = &card->files[card->open];
    if (card->position >= file->size)
        return -1;
    return (unsigned char)card->bytes[file->start + card->position++];
}
