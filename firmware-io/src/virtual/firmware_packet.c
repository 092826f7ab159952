/* The binary mode: control packets, and files that come in packets. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "virtual/machine.h"

enum { SYNC = 0x01, CLOSE = 0x02 };                                          /* control */
enum { QUERY = 0x10, OPEN = 0x11, SHUT = 0x12, WRITE = 0x13, ABORT = 0x14 }; /* files */

static void say(fio_machine *machine, const char *before, int number, const char *after) {
    char bytes[80];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, before);
    fio_text_integer(&text, number);
    fio_text_string(&text, after);
    fio_firmware_say(machine, bytes);
}

void fio_firmware_binary(fio_machine *machine) {
    fio_transfer *transfer = &machine->transfer;
    *transfer = (fio_transfer){.on = true, .number = transfer->number, .deadline = INFINITY};
    fio_firmware_say(machine, "echo:Switching to Binary Protocol");
}

static void ask_again(fio_machine *machine) {
    fio_transfer *transfer = &machine->transfer;
    say(machine, "echo:Resend request ", ++transfer->retries, "");
    say(machine, "rs", transfer->number, "");
    machine->counts.resends++;
}

/* Payload of OPEN: whether it is a dummy, whether it is compressed, the name with its 0. */
static const char *open_file(fio_machine *machine, int size) {
    fio_transfer *transfer = &machine->transfer;
    const uint8_t *payload = transfer->packet.payload;
    if (transfer->writing)
        return "PFT:busy";
    if (size < 4 || payload[size - 1] != 0 || (payload[1] & 1))
        return "PFT:fail";
    transfer->dummy = payload[0] & 1;
    if (!transfer->dummy && !fio_card_create(&machine->card, (const char *)payload + 2))
        return "PFT:fail";
    transfer->writing = true;
    return "PFT:success";
}

static const char *close_file(fio_machine *machine, bool abort) {
    fio_transfer *transfer = &machine->transfer;
    fio_card *card = &machine->card;
    if (!transfer->writing)
        return abort ? "PFT:success" : "PFT:invalid";
    bool full = card->full;
    transfer->writing = false;
    if (transfer->dummy)
        return "PFT:success";
    char name[FIO_CARD_NAME];
    snprintf(name, sizeof name, "%s", card->files[card->open].name);
    fio_card_close(card);
    if (abort)
        fio_card_delete(card, name);
    return full && !abort ? "PFT:ioerror" : "PFT:success";
}

static void process(fio_machine *machine, int kind, int size) {
    fio_transfer *transfer = &machine->transfer;
    const char *answer = NULL;
    switch (kind) {
    case CLOSE:
        close_file(machine, true);
        transfer->on = false;
        break;
    case QUERY:
        answer = "PFT:version:0.1.0:compresion:none"; /* Marlin's own spelling */
        break;
    case OPEN:
        answer = open_file(machine, size);
        break;
    case SHUT:
    case ABORT:
        answer = close_file(machine, kind == ABORT);
        break;
    case WRITE:
        if (!transfer->writing)
            answer = "PFT:invalid";
        else if (!transfer->dummy &&
                 !fio_card_write(&machine->card, (const char *)transfer->packet.payload,
                                 (size_t)size))
            answer = "PFT:ioerror";
        break;
    default:
        answer = kind >> 4 == 0   ? "echo:Unknown BinaryProtocolControl Packet"
                 : kind >> 4 == 1 ? "PTF:invalid"
                                  : "echo:Unsupported Binary Protocol";
    }
    if (answer)
        fio_firmware_say(machine, answer);
}

static void take(fio_machine *machine) {
    fio_transfer *transfer = &machine->transfer;
    const fio_packet *packet = &transfer->packet;
    int number = fio_packet_number(packet), size = fio_packet_size(packet);
    if (fio_packet_kind(packet) == SYNC) {
        say(machine, "ss", transfer->number, ",96,0.1.0");
    } else if (number == transfer->number) {
        transfer->number++;
        transfer->retries = 0;
        say(machine, "ok", number, "");
        process(machine, fio_packet_kind(packet), size);
    } else if (number == (uint8_t)(transfer->number - 1)) {
        say(machine, "ok", number, ""); /* the ok must have been lost */
    } else if (transfer->retries == 0) {
        fio_firmware_say(machine, "echo:Datastream packet out of order");
        ask_again(machine);
    }
}

void fio_firmware_take_packet_byte(fio_machine *machine, uint8_t byte) {
    fio_transfer *transfer = &machine->transfer;
    fio_packet_event event = fio_packet_feed(&transfer->packet, byte);
    int number = fio_packet_number(&transfer->packet);
    switch (event) {
    case FIO_PACKET_WHOLE:
        take(machine);
        break;
    case FIO_PACKET_BAD_HEADER:
        say(machine, "echo:Packet header(", number, "?) corrupt");
        ask_again(machine);
        break;
    case FIO_PACKET_BAD_PAYLOAD:
        say(machine, "echo:Packet(", number, ") payload corrupt");
        ask_again(machine);
        break;
    case FIO_PACKET_TOO_LONG:
        fio_firmware_say(machine, "echo:Datastream packet data buffer overrun");
        say(machine, "fe", number, "");
        transfer->number = 0;
        transfer->retries = 0;
        break;
    default:
        break;
    }
    transfer->deadline = fio_packet_begun(&transfer->packet)
                             ? machine->now + FIO_PACKET_RETRY_MILLISECONDS / 1e3
                             : INFINITY;
}

void fio_firmware_packet_late(fio_machine *machine) {
    fio_transfer *transfer = &machine->transfer;
    if (!transfer->on || machine->now < transfer->deadline)
        return;
    transfer->packet = (fio_packet){0};
    transfer->deadline = INFINITY;
    fio_firmware_say(machine, "echo:Datastream timeout");
    ask_again(machine);
}
