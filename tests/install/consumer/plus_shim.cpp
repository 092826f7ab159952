// The headers as a program in C++ meets them.
#include <isoslice/isoslice.h>

#include <memory>

extern "C" int bytes_of_a_job(const char *model, const char *output) {
    auto options = std::make_unique<iso_options>();
    iso_options_defaults(options.get());
    iso_report report = {};
    iso_status status = iso_job_run(&report, options.get(), &model, 1, output, nullptr);
    int bytes = status == ISO_OK ? static_cast<int>(report.print.bytes) : 0;
    iso_report_free(&report);
    return bytes;
}
