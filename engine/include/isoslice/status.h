/* Status codes and the message that goes with the last failure.
 *
 * Every function that can fail returns an iso_status. On failure it leaves no output behind and
 * leaks nothing, and iso_error_message() says in words where and what. */
#ifndef ISOSLICE_STATUS_H
#define ISOSLICE_STATUS_H

/* In front of every public function: it has C's linkage in C++ too. */
#if defined(ISO_BUILDING_LIBRARY) && defined(__GNUC__)
#define ISO_API __attribute__((visibility("default")))
#elif defined(__cplusplus)
#define ISO_API extern "C"
#else
#define ISO_API
#endif

#if defined(__GNUC__)
#define ISO_MUST_CHECK __attribute__((warn_unused_result))
#define ISO_PRINTF(text, values) __attribute__((format(printf, text, values)))
#else
#define ISO_MUST_CHECK
#define ISO_PRINTF(text, values)
#endif

/* The values are the program's exit codes. */
typedef enum iso_status {
    ISO_OK = 0,
    ISO_USAGE = 2,        /* a call or a command line that makes no sense */
    ISO_UNREADABLE = 3,   /* a file that can't be read or is no model */
    ISO_UNSLICEABLE = 4,  /* a model that can't be sliced truthfully */
    ISO_OUTSIDE = 5,      /* a model outside the printer's volume, or of the kernel's range */
    ISO_BAD_CONFIG = 6,   /* an option out of its range, a configuration that can't be read */
    ISO_NOT_WRITTEN = 7,  /* output that could not be written */
    ISO_NOT_VERIFIED = 8, /* a result that failed its own check */
    ISO_NO_MEMORY = 69,   /* the allocator said no */
    ISO_BUG = 70          /* the impossible happened: a defect of this library */
} iso_status;

/* The message of this thread's last failure; "" if there was none. Valid until the next failure. */
ISO_API const char *iso_error_message(void);

/* Set this thread's message and return `status`. */
ISO_API iso_status iso_fail(iso_status status, const char *format, ...) ISO_PRINTF(2, 3);

/* Return from the calling function if `expression` did not succeed. */
#define ISO_TRY(expression)                                                                        \
    do {                                                                                           \
        iso_status iso_try_status = (expression);                                                  \
        if (iso_try_status != ISO_OK)                                                              \
            return iso_try_status;                                                                 \
    } while (0)

#endif
