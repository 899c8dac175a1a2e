// SPDX-License-Identifier: Apache-2.0
// patency report: the page of results that are there.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "command_line.h"
#include "commands.h"
#include "patency/io/output_folder.h"
#include "patency/report/page.h"
#include "patency/report/sweep.h"

namespace patency::app {

void add_report_command(const Command& program, ExitCode& exit_code) {
    const Command command = program.add_command("report", "make the page report.html of a folder of results again");
    const auto out = std::make_shared<std::string>();
    command.add_option("OUT", *out, "the folder that patency flow, deploy, run or sweep wrote").required();
    command.when_given([out, &exit_code] {
        if (!is_output_folder(*out))
            throw FileError(fmt::format("'{}' is no folder of results of this program.", *out));
        if (is_sweep(*out))
            write_sweep(*out, read_sweep(*out), PATENCY_VERSION);
        else
            write_report(*out, PATENCY_VERSION);
        fmt::print("{}\n", (std::filesystem::path(*out) / "report.html").string());
        exit_code = ExitCode::ok;
    });
}

}   // namespace patency::app
