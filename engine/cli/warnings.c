#include "warnings.h"

#include <stdio.h>
#include <string.h>

iso_status iso_warnings_add(iso_report *report, const iso_config_notes *notes) {
    if (notes->unknown_count > 0)
        ISO_TRY(iso_report_warn(report, "unknown-setting", "%d %s: %s", notes->unknown_count,
                                notes->unknown_count == 1
                                    ? "setting is not isoslice's and was left out"
                                    : "settings are not isoslice's and were left out",
                                notes->unknown));
    if (notes->unused_count > 0)
        ISO_TRY(iso_report_warn(report, "setting-not-followed",
                                "not followed, for isoslice doesn't know it: %s", notes->unused));
    return ISO_OK;
}

void iso_warnings_print(const iso_report *report) {
    enum { SHOWN = 240 };
    for (int32_t i = 0; i < report->warning_count; i++) {
        const char *message = report->warning[i].message;
        fprintf(stderr, "isoslice: warning: %.*s%s [%s]\n", SHOWN, message,
                strlen(message) > SHOWN ? "..." : "", report->warning[i].code);
    }
}
