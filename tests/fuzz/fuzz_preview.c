/* Bytes as G-code: a picture or a refusal. */
#include "fuzz.h"

#include <unistd.h>

#include <isoslice/preview.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static char path[64];
    snprintf(path, sizeof path, "fuzz-preview.%ld", (long)getpid());
    FILE *file = fopen(path, "wb");
    if (!file)
        abort();
    fwrite(bytes, 1, size, file);
    fclose(file);
    iso_preview_options options = iso_preview_defaults();
    iso_status status = iso_preview_svg("/dev/null", path, &options);
    remove(path);
    if (status != ISO_OK && status != ISO_UNREADABLE)
        fuzz_right(status);
    return 0;
}
