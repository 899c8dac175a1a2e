// SPDX-License-Identifier: Apache-2.0
// One function per command: it adds the command with its options to the program's arguments. What the command then does
// returns an exit code through `exit_code`; errors are thrown and become exit codes in main.cpp.
#pragma once

#include "patency/base/errors.h"

namespace CLI {
class App;
}

namespace patency::app {

class Command;

void add_version_command(const Command& program, ExitCode& exit_code);
void add_schema_command(const Command& program, ExitCode& exit_code);
void add_init_command(const Command& program, ExitCode& exit_code);
void add_check_command(const Command& program, ExitCode& exit_code);
void add_inspect_command(const Command& program, ExitCode& exit_code);
void add_stent_command(const Command& program, ExitCode& exit_code);
void add_estimate_command(const Command& program, ExitCode& exit_code);
void add_flow_command(const Command& program, ExitCode& exit_code);
void add_deploy_command(const Command& program, ExitCode& exit_code);
void add_solid_command(const Command& program, ExitCode& exit_code);
void add_run_command(const Command& program, ExitCode& exit_code);
void add_sweep_command(const Command& program, ExitCode& exit_code);
void add_report_command(const Command& program, ExitCode& exit_code);
void add_verify_command(const Command& program, ExitCode& exit_code);
void add_bench_command(const Command& program, ExitCode& exit_code);
void add_man_command(CLI::App& program, ExitCode& exit_code);
void add_completion_command(CLI::App& program, ExitCode& exit_code);

}   // namespace patency::app
