/* What is known of each firmware before it says anything, and what it tells of itself. */
#ifndef FIO_PROTOCOL_FIRMWARE_H
#define FIO_PROTOCOL_FIRMWARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "protocol/answer.h"

typedef enum fio_firmware_kind {
    FIO_FIRMWARE_UNKNOWN,
    FIO_FIRMWARE_MARLIN,
    FIO_FIRMWARE_PRUSA,
    FIO_FIRMWARE_KLIPPER,
    FIO_FIRMWARE_REPRAP, /* RepRapFirmware, of Duet boards */
    FIO_FIRMWARE_SMOOTHIE,
    FIO_FIRMWARE_REPETIER,
    FIO_FIRMWARE_GRBL,
    FIO_FIRMWARE_KINDS
} fio_firmware_kind;

/* A row of the table; what M115 and its Cap lines tell overrides it. */
typedef struct fio_firmware {
    fio_firmware_kind kind;
    const char *name;        /* "Marlin" */
    const char *identity;    /* found in FIRMWARE_NAME or the banner */
    bool numbered;           /* takes N…*checksum: exactly once can be promised */
    bool resends;            /* asks for a line again by Resend or rs */
    bool repeats_dropped;    /* a line whose number it has just had is dropped, without an ok; older
                              * versions ask for the next one instead */
    int receive_bytes;       /* of its receive buffer that may be filled; 0: not known, so that
                              * only one line may be under way */
    int command_slots;       /* commands it queues besides; 1 where it is not known */
    int told_slots;          /* by the last ok */
    int usual_receive_bytes; /* as it comes, if nobody changed it: for who is sure of that, and… */
    int usual_command_slots; /* …for a firmware that tells its slots; 0, 1: unknown */
    int planner_blocks;      /* moves accepted but not yet made, at most */
    int line_most;           /* bytes of a line it keeps, without the end */
    double busy_seconds;     /* between two "busy:" while it works on a command; 0: says nothing */
    double boot_seconds;     /* from a reset until it listens */
    bool emergency_parser;   /* M108, M112, M410 act while commands wait (a capability tells) */
    bool auto_temperatures;  /* M155 */
    bool auto_position;      /* M154 */
    bool auto_sd;            /* M27 S */
    bool advanced_ok;        /* seen, never assumed */
    bool action_prompts;     /* M876 */
    bool meatpack;           /* seen, never assumed */
    bool sd_upload;          /* M28/M29 */
    int tools;               /* nozzles it told of; 1 */
    const char *heaters_off; /* commands parted by '\n' that make it safe: heaters and fan off, of
                              * the active nozzle where there are several */
    const char *stop;        /* bytes of an emergency stop: "\nM112\n", its first LF ends what may
                              * be under way half; "\x18" for grbl */
} fio_firmware;

const fio_firmware *fio_firmware_of(fio_firmware_kind kind);

/* The row that fits an answer of kind FIRMWARE or START; FIO_FIRMWARE_UNKNOWN's if none does. */
const fio_firmware *fio_firmware_identify(const fio_answer *answer);

/* Let an answer change what is known: a "Cap:", an ok with P and B, the EXTRUDER_COUNT of M115. The
 * kind stays; anything else changes nothing. Slots are what two oks in
 * a row told to be free at least: one number alone may be damaged. */
void fio_firmware_learn(fio_firmware *firmware, const fio_answer *answer);

/* How a command behaves: may it take long without anything being wrong, does it make moves … */
typedef enum fio_command_trait {
    FIO_COMMAND_LONG = 1,   /* G28, G29, G4, M109, M190, M400, M600, M0, M1, M303, T, a macro … */
    FIO_COMMAND_MOVES = 2,  /* goes through the planner */
    FIO_COMMAND_DRAINS = 4, /* is answered once all moves before it are made */
    FIO_COMMAND_USER = 8,   /* waits for a person: M0, M1, M600 */
    FIO_COMMAND_HEATS = 16,
    FIO_COMMAND_STOPS = 32,     /* M108, M112, M410, M876: out of band */
    FIO_COMMAND_NUMBERS = 64,   /* M110, which a job must not contain */
    FIO_COMMAND_SD_WRITE = 128, /* M28, M29: likewise */
    FIO_COMMAND_RESETS = 256    /* M997, M999, FIRMWARE_RESTART: likewise */
} fio_command_trait;

unsigned fio_command_traits(const char *command, size_t length);

#endif
