/* From the bytes that arrive to the lines in the queue. */
#include <string.h>

#include "virtual/machine.h"

bool fio_firmware_may_receive(const fio_machine *machine) {
    if (machine->processor == FIO_BOOTING || machine->processor == FIO_HALTED)
        return true; /* and lost */
    return machine->received_last - machine->received_first <
           (unsigned)machine->options.receive_bytes - 1; /* a ring keeps one place empty */
}

static bool is_end(uint8_t byte) {
    return byte == '\n' || byte == '\r';
}

/* A line that is lost as a whole damages no other. */
void fio_firmware_lose(fio_machine *machine, uint8_t byte) {
    machine->lost_before = !is_end(byte) || machine->mid_line;
}

static bool out_of_band(const fio_machine *machine) {
    return machine->options.emergency_parser && machine->dialect->out_of_band;
}

void fio_firmware_receive(fio_machine *machine, uint8_t byte, bool tainted) {
    if (machine->processor == FIO_HALTED && byte == '\n' && machine->dialect->dead)
        fio_firmware_say_lines(machine, machine->dialect->dead);
    if (machine->processor == FIO_HALTED && byte == 0x18 && !machine->dialect->identity)
        machine->plan.reset = machine->quick_reset = true;
    if (machine->processor == FIO_BOOTING || machine->processor == FIO_HALTED) {
        fio_firmware_lose(machine, byte);
        return;
    }
    if (machine->dialect->numbering == FIO_NUMBERS_IGNORED && !machine->dialect->out_of_band &&
        fio_firmware_real_time(machine, byte))
        return;
    if (out_of_band(machine)) {
        fio_emergency what = fio_emergency_feed(&machine->emergency, (char)byte);
        if (what && machine->now < machine->plan.silent_until)
            machine->pending = what;
        else
            fio_firmware_emergency(machine, what);
        if (machine->processor == FIO_HALTED)
            return;
    }
    if (!fio_firmware_may_receive(machine)) {
        machine->counts.overruns++;
        fio_firmware_lose(machine, byte);
        return;
    }
    tainted = tainted || machine->lost_before;
    machine->lost_before = false;
    machine->mid_line = !is_end(byte);
    machine->received[machine->received_last++ & (FIO_RECEIVE_MOST - 1)] =
        (uint16_t)(byte | (tainted ? FIO_TAINT : 0));
}

/* Where the line is damaged first; bytes lost show at the one after them. */
static void note_taint(fio_machine *machine) {
    machine->line_tainted = machine->line_tainted || machine->reader.done;
    int at = machine->reader.length > 0 ? machine->reader.length - 1 : 0;
    machine->taint_at = at < machine->taint_at ? at : machine->taint_at;
}

static void report_packing(fio_machine *machine) {
    const fio_unpacker *unpacker = &machine->unpacker;
    char bytes[32];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "[MP] PV01 ");
    fio_text_string(&text, unpacker->on ? "ON " : "OFF ");
    fio_text_string(&text, unpacker->no_spaces ? "NSP" : "ESP");
    fio_firmware_say(machine, bytes);
}

/* Damage behind the checksum changes nothing that is executed. */
static bool is_tainted(const fio_machine *machine) {
    const char *text = machine->reader.text, *star = strrchr(text, '*');
    int end = *text == 'N' && star ? (int)(star - text) : INT32_MAX - 1;
    return machine->line_tainted || machine->taint_at <= end;
}

/* Without an emergency parser these act when they are read, as long as they bear no number. */
static void act_early(fio_machine *machine, const char *text) {
    if (out_of_band(machine))
        return;
    if (!strncmp(text, "M108", 4))
        fio_firmware_emergency(machine, FIO_EMERGENCY_BREAK);
    if (!strncmp(text, "M112", 4))
        fio_firmware_emergency(machine, FIO_EMERGENCY_KILL);
    if (!strncmp(text, "M410", 4))
        fio_firmware_emergency(machine, FIO_EMERGENCY_STOP);
}

static fio_queued *enqueue(fio_machine *machine, const fio_reader *reader) {
    int slot = (machine->oldest + machine->queued++) % machine->options.command_slots;
    fio_queued *queued = &machine->queue[slot];
    memcpy(queued->text, reader->text, (size_t)reader->length + 1);
    queued->length = reader->length;
    queued->cut = reader->cut;
    queued->tainted = queued->silent = queued->from_card = false;
    return queued;
}

static void take_line(fio_machine *machine) {
    fio_reader *reader = &machine->reader;
    fio_virtual_printer *printer = machine->printer;
    machine->counts.lines_in++;
    fio_script_happens(machine, FIO_AT_LINE, (double)machine->counts.lines_in);
    if (machine->plan.reset || machine->plan.halt)
        return;
    if (machine->plan.reject_lines > 0) {
        machine->plan.reject_lines--;
        fio_firmware_reject(machine, FIO_LINE_CHECKSUM, reader->text);
        return;
    }
    int64_t before = printer->last_number;
    if (!fio_firmware_accepts(machine, reader->text))
        return;
    if (printer->last_number != before)
        fio_script_happens(machine, FIO_AT_NUMBER, (double)printer->last_number);
    act_early(machine, reader->text);
    if (machine->processor == FIO_HALTED)
        return;
    if (machine->dialect->early_ok)
        fio_firmware_early_ok(machine, reader->text);
    if (machine->plan.reset || machine->plan.halt)
        return;
    fio_queued *queued = enqueue(machine, reader);
    queued->tainted = is_tainted(machine);
    queued->silent = machine->dialect->early_ok;
}

static void enqueue_from_card(fio_machine *machine) {
    fio_queued *queued = enqueue(machine, &machine->card_reader);
    queued->silent = queued->from_card = true;
}

static void read_character(fio_machine *machine, char character, bool tainted) {
    fio_reader *reader = &machine->reader;
    bool whole = fio_reader_feed(reader, character);
    if (tainted)
        note_taint(machine);
    if (whole)
        take_line(machine);
    if (!machine->dialect->identity && reader->done && reader->length == 0)
        fio_firmware_ok(machine); /* grbl answers empty lines, too */
    if (reader->done) {           /* a false end of line taints the line after it, too */
        machine->line_tainted = tainted;
        machine->taint_at = INT32_MAX;
    }
}

void fio_firmware_read(fio_machine *machine) {
    while (machine->queued < machine->options.command_slots && !machine->plan.reset &&
           !machine->plan.halt && machine->received_first != machine->received_last) {
        uint16_t got = machine->received[machine->received_first++ & (FIO_RECEIVE_MOST - 1)];
        if (machine->transfer.on) {
            fio_firmware_take_packet_byte(machine, (uint8_t)got);
            continue;
        }
        char text[4] = {(char)(got & 0xff)};
        int count = 1;
        bool told = false;
        if (machine->dialect->capabilities)
            count = fio_unpacker_feed(&machine->unpacker, (uint8_t)got, text, &told);
        if (told)
            report_packing(machine);
        if (count == 0 && (got & FIO_TAINT)) /* it shows in what comes of it */
            machine->line_tainted = true;
        for (int i = 0; i < count; i++)
            read_character(machine, text[i], got & FIO_TAINT);
    }
    while (machine->queued < machine->options.command_slots && fio_firmware_card_line(machine))
        enqueue_from_card(machine);
}
