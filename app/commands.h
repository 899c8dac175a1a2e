// SPDX-License-Identifier: Apache-2.0
// One function per command: it adds the command with its options to the program's arguments. What the command then does
// returns an exit code through `exit_code`; errors are thrown and become exit codes in main.cpp.
#pragma once

#include "patency/base/errors.h"

namespace CLI {
class App;
}

namespace patency::app {

void add_version_command(CLI::App& program, ExitCode& exit_code);
void add_schema_command(CLI::App& program, ExitCode& exit_code);
void add_init_command(CLI::App& program, ExitCode& exit_code);
void add_check_command(CLI::App& program, ExitCode& exit_code);
void add_inspect_command(CLI::App& program, ExitCode& exit_code);
void add_stent_command(CLI::App& program, ExitCode& exit_code);
void add_estimate_command(CLI::App& program, ExitCode& exit_code);
void add_flow_command(CLI::App& program, ExitCode& exit_code);
void add_deploy_command(CLI::App& program, ExitCode& exit_code);
void add_solid_command(CLI::App& program, ExitCode& exit_code);
void add_run_command(CLI::App& program, ExitCode& exit_code);
void add_sweep_command(CLI::App& program, ExitCode& exit_code);
void add_report_command(CLI::App& program, ExitCode& exit_code);
void add_verify_command(CLI::App& program, ExitCode& exit_code);
void add_bench_command(CLI::App& program, ExitCode& exit_code);
void add_man_command(CLI::App& program, ExitCode& exit_code);
void add_completion_command(CLI::App& program, ExitCode& exit_code);

}  // namespace patency::app
