/* A virtual printer: a Marlin-like G-code interpreter in process, with heaters, limits, a planner
 * and a record of what it did.
 *
 * Lines go in one at a time, as a serial port would bring them; answers come out through a
 * callback. Nothing waits: time is virtual and advances with the moves, the heaters and the dwells.
 * Everything is deterministic: the same lines give the same answers, times and faults. Memory is
 * one block of fixed size, however long the print is.
 *
 * Units: mm, s, °C, mm/s, mm/s², mm³ (and mm³/s); G-code's own mm/min and inches are converted on
 * the way in. Axes are always in the order x, y, z, e. Machine coordinates are what the end stops
 * see; logical ones are what G92 made of them. */
#ifndef ISOPRINT_VIRTUAL_PRINTER_H
#define ISOPRINT_VIRTUAL_PRINTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FIO_EVENTS_KEPT 100 /* faults and warnings kept with their text; all are counted */
#define FIO_TOOLS_MOST 8    /* nozzles */
#define FIO_BLOCKS_MOST 64  /* of the planner */
#define FIO_LINE_MOST 95    /* bytes of a command that Marlin keeps (MAX_CMD_SIZE - 1) */

typedef enum fio_flavour { FIO_FLAVOUR_MARLIN } fio_flavour;

/* First-order: at full power T tends to `full_power`, switched off to the room's temperature, both
 * as exp(-t / time_constant); the control is perfect, so T stays at its target once there. */
typedef struct fio_heater_options {
    double maximum;       /* highest target allowed, °C */
    double full_power;    /* temperature reached after an endless time at full power, > maximum */
    double time_constant; /* s */
} fio_heater_options;

typedef struct fio_virtual_options {
    fio_flavour flavour;
    double origin[3]; /* lowest machine coordinate of each axis, where homing ends; 0 */
    double size[3];   /* of the volume: 250, 210, 210 */
    fio_heater_options nozzle, bed;
    double room_temperature;              /* 20 */
    double extrusion_minimum_temperature; /* colder than this E does not move: 170 */
    double extrusion_maximum_length; /* E travel of one move beyond which it is prevented: 200 */
    double filament_diameter;        /* 1.75 */
    double maximum_flow;             /* mm³/s above which a warning is given: 15 */
    double maximum_feedrate[4];      /* 500, 500, 12, 120 */
    double maximum_acceleration[4];  /* 9000, 9000, 500, 10000 */
    double print_acceleration, retract_acceleration, travel_acceleration; /* 1500 each */
    double junction_deviation;                                            /* mm: 0.013 */
    bool classic_jerk;          /* corners by `jerk` instead of the junction deviation */
    double jerk[4];             /* 10, 10, 0.4, 2.5 mm/s */
    double homing_feedrate[3];  /* 50, 50, 8 */
    double firmware_retract[2]; /* of G10 and G11: length 2 mm, feedrate 40 mm/s */
    int tools;                  /* 1 … FIO_TOOLS_MOST: 1 */
    int planner_blocks;         /* 2 … FIO_BLOCKS_MOST: 16, as Marlin's BLOCK_BUFFER_SIZE */
} fio_virtual_options;

/* What a fault or a warning is. A fault is what would spoil the print, damage the printer or make
 * the firmware refuse; a warning is worth a look. */
typedef enum fio_event_code {
    FIO_FAULT_OUTSIDE,           /* a move out of the volume; clamped, as Marlin's end stops do */
    FIO_FAULT_NOT_HOMED,         /* a move of an axis whose position is unknown */
    FIO_FAULT_COLD_EXTRUSION,    /* E moved below the least temperature; prevented */
    FIO_FAULT_LONG_EXTRUSION,    /* E moved too far in one move (a forgotten G92 E0); prevented */
    FIO_FAULT_NO_FEEDRATE,       /* an extruding move before any F; Marlin's 25 mm/s are used */
    FIO_FAULT_BAD_FEEDRATE,      /* F0 or less; ignored */
    FIO_FAULT_BAD_ARC,           /* no centre, or radii that differ; not executed */
    FIO_FAULT_BAD_WORD,          /* a missing, infinite or absurd number, a stray byte; ignored */
    FIO_FAULT_BAD_SETTING,       /* a limit or a percentage that is not positive; ignored */
    FIO_FAULT_TEMPERATURE,       /* a target out of range (clamped) or one that is never reached */
    FIO_FAULT_BAD_TOOL,          /* a tool the printer has not */
    FIO_FAULT_LINE_TOO_LONG,     /* a G command longer than FIO_LINE_MOST bytes; cut */
    FIO_FAULT_LINE_LOST,         /* a rejected line that was never sent again */
    FIO_FAULT_HALTED,            /* M112, and every line after it */
    FIO_FAULT_HEATER_LEFT_ON,    /* at the end */
    FIO_WARNING_UNKNOWN_COMMAND, /* the first warning: codes before it are faults */
    FIO_WARNING_RETRACTED,       /* extruding along a path while filament is still retracted */
    FIO_WARNING_OVERPRIMED,      /* more pushed in place than was retracted, once printing */
    FIO_WARNING_FLOW,            /* more plastic a second than maximum_flow */
    FIO_WARNING_TEXT_CUT,        /* an M command longer than FIO_LINE_MOST bytes; cut */
    FIO_WARNING_FAN_LEFT_ON,     /* at the end */
    FIO_EVENT_CODES
} fio_event_code;

typedef struct fio_event {
    fio_event_code code;
    int64_t line; /* 1 = the first line given; 0 = at the end */
    char text[116];
} fio_event;

typedef enum fio_activity {
    FIO_EXTRUDING, /* along a path */
    FIO_TRAVELLING,
    FIO_RETRACTING, /* E alone, either way */
    FIO_LIFTING,    /* z alone */
    FIO_HOMING,
    FIO_HEATING, /* waiting for a temperature */
    FIO_DWELLING,
    FIO_ACTIVITIES
} fio_activity;

typedef struct fio_statistics {
    int64_t lines;    /* given, empty ones and comments included */
    int64_t commands; /* executed */
    int64_t unknown_commands;
    int64_t rejected_lines;  /* answered by Resend */
    int64_t duplicate_lines; /* dropped because their number was that of a line just executed */
    int64_t moves, extrusion_moves, arcs;
    int64_t retractions, unretractions;
    int64_t layers; /* level changes of z between level extrusions */
    int64_t fault_count, warning_count;
    int64_t count[FIO_EVENT_CODES];
    double time[FIO_ACTIVITIES]; /* s */
    double total_time;           /* their sum */
    double filament;             /* mm pushed beyond the furthest point before: what a print uses */
    double extruded_along_paths; /* mm of filament in extruding moves */
    double volume;               /* mm³ of `filament` */
    double extrusion_length;     /* mm of paths */
    double travel_length;        /* mm of moves in x, y, z without extrusion */
    double turned[3];            /* degrees that axes A, B and C went, either way */
    double retracted_length, unretracted_length; /* mm of filament, summed */
    double retracted;                            /* mm still retracted now, of the tool in use */
    double extrusion_minimum[3],
        extrusion_maximum[3];           /* machine box; valid if extrusion_moves > 0 */
    double highest_flow;                /* mm³/s */
    double highest_nozzle, highest_bed; /* °C reached */
} fio_statistics;

typedef struct fio_state {
    double time;        /* s since the start: moves still in the planner are not in it */
    double position[4]; /* logical, after all lines given */
    double machine[3];
    double angle[3]; /* degrees: A, B, C, which turn the part */
    bool homed[3];
    bool inches, absolute, absolute_extrusion;
    bool inverse_time; /* G93 holds: F is one over the minutes of each move */
    bool halted;
    int64_t line_number; /* of the last numbered line */
    double feedrate;     /* mm/s, before feedrate_percent; 0 = none given yet */
    double feedrate_percent, flow_percent;
    double acceleration[3]; /* print, retract, travel */
    double fan;             /* 0 … 255 */
    double nozzle[FIO_TOOLS_MOST], nozzle_target[FIO_TOOLS_MOST];
    double bed, bed_target;
    int tool;
    int progress_percent, minutes_left; /* of M73; -1 if never told */
} fio_state;

/* One executed line. Entries come in the order of the lines, each line that was executed once; a
 * move's comes when the move is done, so at the latest in fio_virtual_printer_finish(). A command
 * that is no move takes its turn between the moves around it; its effect on heaters comes when it
 * is read, as in Marlin, which is up to planner_blocks moves earlier. */
typedef struct fio_executed {
    int64_t line;       /* 1 = the first line given */
    int64_t number;     /* N of the line, -1 if it had none */
    double start;       /* s */
    double duration;    /* s */
    double position[4]; /* machine x, y, z and logical e where the line leaves them */
    const char *text;   /* the command: no comment, N or checksum; ends with a 0 */
    size_t length;      /* of text */
    bool known;         /* false: the firmware does not know this command, and did nothing */
} fio_executed;

typedef struct fio_execution_log {
    void (*entry)(void *context, const fio_executed *executed); /* NULL: no log */
    void *context;
} fio_execution_log;

/* An answer: one line without its end. */
typedef void fio_reply(void *context, const char *text, size_t length);

typedef struct fio_virtual_printer fio_virtual_printer;

FIO_API fio_virtual_options fio_virtual_options_defaults(void);

/* Make a printer, cold, not homed. *printer is the caller's, to be freed. `options` and `log` may
 * be NULL. FIO_USAGE for options out of range, FIO_NO_MEMORY; then *printer is NULL. */
FIO_API fio_status fio_virtual_printer_create(fio_virtual_printer **printer,
                                              const fio_virtual_options *options,
                                              const fio_execution_log *log) FIO_MUST_CHECK;
FIO_API void fio_virtual_printer_free(fio_virtual_printer *printer); /* NULL is fine */

/* Execute one line of any bytes, with or without its line end. `reply` may be NULL. FIO_OK also for
 * faulty lines: faults are counted, not returned. FIO_REJECTED if the line was not executed because
 * it must be sent again or the printer is halted; FIO_USAGE after fio_virtual_printer_finish(). */
FIO_API fio_status fio_virtual_printer_execute(fio_virtual_printer *printer, const char *line,
                                               size_t length, fio_reply *reply,
                                               void *context) FIO_MUST_CHECK;

/* Execute all lines of a text; the same as one call for each. Stops at nothing. */
FIO_API fio_status fio_virtual_printer_run(fio_virtual_printer *printer, const char *text,
                                           size_t length) FIO_MUST_CHECK;

/* End of the print: let the planner's moves finish and look at what was left on. FIO_FAULTY if
 * there were any faults at all (the message names the first one), FIO_USAGE if called twice. */
FIO_API fio_status fio_virtual_printer_finish(fio_virtual_printer *printer) FIO_MUST_CHECK;

FIO_API void fio_virtual_printer_state(const fio_virtual_printer *printer, fio_state *state);

/* Valid as long as the printer; changes with it. Times of moves still in the planner are missing
 * until fio_virtual_printer_finish(). */
FIO_API const fio_statistics *fio_virtual_printer_statistics(const fio_virtual_printer *printer);

/* The first FIO_EVENTS_KEPT faults or warnings, oldest first. NULL if there is no such one. */
FIO_API const fio_event *fio_virtual_printer_fault(const fio_virtual_printer *printer,
                                                   int64_t index);
FIO_API const fio_event *fio_virtual_printer_warning(const fio_virtual_printer *printer,
                                                     int64_t index);

FIO_API const char *fio_event_name(fio_event_code code); /* "outside", "cold_extrusion", … */
FIO_API const char *fio_activity_name(fio_activity activity);

#ifdef __cplusplus
}
#endif

#endif
