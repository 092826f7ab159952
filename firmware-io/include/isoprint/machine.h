/* A whole printer in memory: a firmware with its buffers, its serial line and its faults around the
 * printer of virtual_printer.h. It stands at the far end of a fake transport, a pseudo terminal, a
 * socket or a USB device that exists only in software.
 *
 * Time is the caller's, in seconds, and never goes back; it may be real, faster, or virtual.
 * Nothing waits and nothing allocates after creation. The same options, script, seed, bytes and
 * times give the same answers and the same log. */
#ifndef ISOPRINT_MACHINE_H
#define ISOPRINT_MACHINE_H

#include <isoprint/transport.h>
#include <isoprint/virtual_printer.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fio_machine fio_machine;

/* Probabilities per line or answer, 0 … 1. */
typedef struct fio_machine_faults {
    double flip_in;       /* one bit of a line on its way to the firmware */
    double flip_out;      /* one bit of an answer */
    double flip_bytes;    /* any number of bits: of each byte, both ways */
    double lose_bytes_in; /* a run of 1 to 8 bytes of a line */
    double lose_ok, double_ok, late_ok;
    double late_seconds; /* of late_ok: 1 */
    double split, merge; /* reads cut anywhere, reads put together */
} fio_machine_faults;

typedef struct fio_machine_options {
    fio_virtual_options printer;
    int64_t rate;        /* bits/s of the wire, 10 bits a byte; 0: native USB, which holds the host
                          * back when the receive buffer is full, where a wire overruns it */
    int receive_bytes;   /* 128 */
    int command_slots;   /* 4 */
    double line_seconds; /* of processor time for each command: 0.0003 */
    double busy_seconds; /* 2; 0: never says busy */
    double boot_seconds; /* from a reset to "start": 1 */
    bool reset_on_dtr;   /* when DTR rises: true, as boards with an ATmega do */
    bool mute_without_dtr; /* false */
    bool advanced_ok;      /* false */
    bool emergency_parser; /* true */
    bool case_insensitive; /* false, as Marlin's GCODE_CASE_INSENSITIVE */
    const char *firmware;  /* "marlin" (the only one that is whole), "klipper", "repetier", "grbl",
                            * "smoothie", "reprapfirmware", "prusa": their dialects of answers */
    uint64_t seed;
    fio_machine_faults faults;
    const char *script; /* text of a script, NULL: none; see docs/virtual-printer.md */
    fio_execution_log log;
} fio_machine_options;

typedef struct fio_machine_counts {
    int64_t bytes_in, bytes_out, lines_in, resends, oks;
    int64_t overruns; /* bytes lost because the receive buffer was full */
    int64_t faults;   /* injected */
    /* Lines executed although what arrived is not what was sent, or is but a part of it: they pass
     * their checksum, or have none. No host can know. Never fewer than there are. */
    int64_t undetectable;
    int64_t starved; /* times the planner ran empty between two moves that extrude, untold */
    int64_t resets;
} fio_machine_counts;

FIO_API fio_machine_options fio_machine_options_defaults(void);

/* FIO_USAGE for options out of range or a script that is wrong: the message says where. */
FIO_API fio_status fio_machine_create(fio_machine **machine,
                                      const fio_machine_options *options) FIO_MUST_CHECK;
FIO_API void fio_machine_free(fio_machine *machine); /* NULL is fine */

/* Bytes from the host; returns how many were taken: as many as the line has room for. A wire holds
 * FIO_MACHINE_LINE_BYTES that have not left yet and carries all of them, lost at the far end or
 * not; native USB holds FIO_MACHINE_PACKET_BYTES until the receive buffer has room. */
#define FIO_MACHINE_LINE_BYTES 512
#define FIO_MACHINE_PACKET_BYTES 64
FIO_API size_t fio_machine_write(fio_machine *machine, double now, const void *bytes, size_t size);
FIO_API size_t fio_machine_room(const fio_machine *machine); /* what write() would take now */

/* Bytes taken that have not arrived yet; discard() makes them never arrive and returns how many of
 * them there were. */
FIO_API size_t fio_machine_pending(const fio_machine *machine);
FIO_API size_t fio_machine_discard(fio_machine *machine, double now);

/* Bytes for the host that have arrived by `now`. What it leaves unread beyond 8 KiB is lost. */
FIO_API size_t fio_machine_read(fio_machine *machine, double now, void *bytes, size_t capacity);
FIO_API bool fio_machine_readable(const fio_machine *machine); /* read() would give some */

/* The modem lines, and the rate the host has set: a wrong one turns bytes to rubbish, both ways. */
FIO_API void fio_machine_set_lines(fio_machine *machine, double now, bool dtr, bool rts);
FIO_API void fio_machine_set_rate(fio_machine *machine, double now, int64_t rate);

/* Let it do what it does by `now`. */
FIO_API void fio_machine_advance(fio_machine *machine, double now);

/* When something will happen that the host can see: bytes to read, room to write. INFINITY: never
 * without the host. Never before the last time passed in. */
FIO_API double fio_machine_next(const fio_machine *machine);

/* Whether it works at what the host sent: bytes under way either way, lines not answered, a command
 * that takes long, moves not made. False while only time of itself makes it speak (reports, wait).
 */
FIO_API bool fio_machine_working(const fio_machine *machine);

/* False after a script pulled the plug; the printer itself lives on. plug() puts it back. */
FIO_API bool fio_machine_plugged(const fio_machine *machine);
FIO_API void fio_machine_plug(fio_machine *machine, double now);

/* End: the moves left are made, then as fio_virtual_printer_finish(). */
FIO_API fio_status fio_machine_finish(fio_machine *machine) FIO_MUST_CHECK;

FIO_API const fio_virtual_printer *fio_machine_printer(const fio_machine *machine);
FIO_API const fio_machine_counts *fio_machine_count(const fio_machine *machine);

/* A transport with this machine at its far end. `speed`: 0 for a virtual clock that jumps from
 * event to event, 1 real time, more: so many times faster. The machine stays the caller's and
 * outlives it. Time starts at `start`, on the machine's clock. */
FIO_API fio_status fio_machine_transport(fio_transport **transport, fio_machine *machine,
                                         double start, double speed) FIO_MUST_CHECK;

#ifdef __cplusplus
}
#endif

#endif
