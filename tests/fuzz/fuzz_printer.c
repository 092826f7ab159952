/* Bytes as G-code for the virtual printer: faults are counted, nothing breaks. */
#include "fuzz.h"

#include <isoprint/virtual_printer.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fio_virtual_printer *printer = NULL;
    if (fio_virtual_printer_create(&printer, NULL, NULL) != FIO_OK)
        abort();
    fio_status status = fio_virtual_printer_run(printer, (const char *)bytes, size);
    if (status != FIO_OK && status != FIO_REJECTED)
        abort();
    status = fio_virtual_printer_finish(printer);
    const fio_statistics *statistics = fio_virtual_printer_statistics(printer);
    if ((status != FIO_OK && status != FIO_FAULTY) || statistics->commands > statistics->lines)
        abort();
    fio_virtual_printer_free(printer);
    return 0;
}
