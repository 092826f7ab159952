/* Status codes of the printer side and the message that goes with the last failure. */
#ifndef ISOPRINT_STATUS_H
#define ISOPRINT_STATUS_H

#if defined(FIO_BUILDING_LIBRARY) && defined(__GNUC__)
#define FIO_API __attribute__((visibility("default")))
#else
#define FIO_API
#endif

#if defined(__GNUC__)
#define FIO_MUST_CHECK __attribute__((warn_unused_result))
#define FIO_PRINTF(text, values) __attribute__((format(printf, text, values)))
#else
#define FIO_MUST_CHECK
#define FIO_PRINTF(text, values)
#endif

/* The values below 64 are the exit codes of the programs. */
typedef enum fio_status {
    FIO_OK = 0,
    FIO_USAGE = 2,       /* a call or a command line that makes no sense */
    FIO_UNREADABLE = 3,  /* a file that can't be read */
    FIO_NOT_WRITTEN = 7, /* output that could not be written */
    FIO_FAULTY = 8,      /* the printer found faults in what it was told to do, or halted */
    FIO_NO_PRINTER = 9,  /* no such port, it may not be opened, or nothing answers there */
    FIO_LINK_LOST = 10,  /* the printer went away, reset or fell silent in the middle of the job */
    FIO_CANCELLED = 11,  /* stopped by its user */
    FIO_REJECTED = 64, /* a line the printer did not execute: it asked for it again, or is halted */
    FIO_NO_MEMORY = 69, /* the allocator said no */
    FIO_BUG = 70        /* the impossible happened: a defect of this library */
} fio_status;

/* The message of this thread's last failure; "" if there was none. Valid until the next failure. */
FIO_API const char *fio_error_message(void);

/* Set this thread's message and return `status`. */
FIO_API fio_status fio_fail(fio_status status, const char *format, ...) FIO_PRINTF(2, 3);

#endif
