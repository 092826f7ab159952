/* The commands of the SD card. */
#include <string.h>

#include "virtual/machine.h"

static void say(fio_machine *machine, const char *before, const char *name, const char *after) {
    char bytes[160];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, before);
    fio_text_string(&text, name);
    fio_text_string(&text, after);
    fio_firmware_say(machine, bytes);
}

static void list(fio_machine *machine) {
    const fio_card *card = &machine->card;
    fio_firmware_say(machine, "Begin file list");
    for (int i = 0; i < card->count && !card->released; i++) {
        char bytes[64];
        fio_text text = fio_text_in(bytes, sizeof bytes);
        fio_text_string(&text, card->files[i].name);
        fio_text_string(&text, " ");
        fio_text_integer(&text, card->files[i].size);
        fio_firmware_say(machine, bytes);
    }
    fio_firmware_say(machine, "End file list");
}

static bool choose(fio_machine *machine, const char *name) {
    if (!fio_card_select(&machine->card, name)) {
        say(machine, "open failed, File: ", name, ".");
        return false;
    }
    char bytes[96];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "File opened: ");
    fio_text_string(&text, name);
    fio_text_string(&text, " Size: ");
    fio_text_integer(&text, machine->card.files[machine->card.open].size);
    fio_firmware_say(machine, bytes);
    fio_firmware_say(machine, "File selected");
    return true;
}

static void start(fio_machine *machine) {
    fio_card *card = &machine->card;
    if (card->open < 0 || card->saving)
        return;
    card->printing = true;
    machine->card_reader = (fio_reader){0};
}

void fio_firmware_say_progress(fio_machine *machine) {
    const fio_card *card = &machine->card;
    if (!card->printing) {
        fio_firmware_say(machine, "Not SD printing");
        return;
    }
    char bytes[80];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "SD printing byte ");
    fio_text_integer(&text, card->position);
    fio_text_string(&text, "/");
    fio_text_integer(&text, card->files[card->open].size);
    fio_firmware_say(machine, bytes);
}

static void write_file(fio_machine *machine, const char *name) {
    if (fio_card_create(&machine->card, name))
        say(machine, "Writing to file: ", name, "");
    else
        say(machine, "open failed, File: ", name, ".");
}

/* Where the name begins: the path is always the root. */
static const char *name_of(const fio_line *line) {
    const char *name = line->text + line->arguments;
    return name + strspn(name, " /!");
}

static void go_to(fio_machine *machine, const fio_line *line) {
    fio_card *card = &machine->card;
    if (card->open < 0 || card->saving || !fio_line_has(line, 'S'))
        return;
    double at = fio_line_value(line, 'S'), size = card->files[card->open].size;
    card->position = at < 0 ? 0 : at > size ? (int)size : (int)at;
}

bool fio_firmware_card(fio_machine *machine, const fio_line *line) {
    fio_card *card = &machine->card;
    const char *name = name_of(line);
    switch (line->code) {
    case 20:
        list(machine);
        return true;
    case 21:
    case 22:
        card->released = line->code == 22;
        card->printing = card->printing && !card->released;
        fio_firmware_say(machine, card->released ? "echo:SD card released" : "echo:SD card ok");
        return true;
    case 23:
        choose(machine, name);
        return true;
    case 24:
        start(machine);
        return true;
    case 25:
    case 524:
        card->printing = false;
        if (line->code == 524)
            card->open = -1;
        return true;
    case 26:
        go_to(machine, line);
        return true;
    case 27:
        if (fio_line_has(line, 'S'))
            fio_firmware_set_interval(machine, line, &machine->card_seconds, &machine->card_at);
        else
            fio_firmware_say_progress(machine);
        return true;
    case 28:
        if (!strncmp(name, "B1", 2) && machine->dialect->capabilities)
            fio_firmware_binary(machine);
        else
            write_file(machine, strncmp(name, "B0 ", 3) ? name : name + 3);
        return true;
    case 29: /* outside of saving */
        return true;
    case 30:
        if (fio_card_delete(card, name))
            say(machine, "File deleted:", name, "");
        else
            say(machine, "Deletion failed, File: ", name, ".");
        return true;
    case 32:
        if (choose(machine, name))
            start(machine);
        return true;
    default:
        return false;
    }
}

void fio_firmware_save_line(fio_machine *machine, const fio_line *line) {
    fio_card *card = &machine->card;
    if (line->letter == 'M' && line->code == 29) {
        fio_firmware_say(machine, card->full ? "echo:SD card full" : "Done saving file.");
        fio_card_close(card);
        return;
    }
    bool whole = fio_card_write(card, line->text, (size_t)line->length);
    if (!whole || !fio_card_write(card, "\n", 1))
        fio_firmware_say(machine, "Error:error writing to file");
}

bool fio_firmware_card_line(fio_machine *machine) {
    fio_card *card = &machine->card;
    while (card->printing) {
        int byte = fio_card_next(card);
        bool whole = fio_reader_feed(&machine->card_reader, (char)(byte < 0 ? '\n' : byte));
        if (byte < 0) {
            card->printing = false;
            fio_firmware_say(machine, "Done printing file");
        }
        if (whole)
            return true;
    }
    return false;
}
