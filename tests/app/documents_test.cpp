// SPDX-License-Identifier: Apache-2.0
// The manual page and the shell's completion say what --help says.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "tests/app/program.h"

namespace patency {
namespace {

std::set<std::string> matches(const std::string& text, const char* pattern) {
    const std::regex expression(pattern);
    std::set<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) found.insert((*at)[1]);
    return found;
}

std::set<std::string> commands() {
    const std::string help = patency("--help").output;
    return matches(help.substr(help.find("Subcommands:")), "\n  ([a-z]+) ");
}

TEST(Documents, TheManualHasEveryCommandAndOption) {
    const Result man = patency("man");
    ASSERT_EQ(man.exit_code, 0);
    std::string plain = man.output;
    for (std::size_t at = plain.find("\\-"); at != plain.npos; at = plain.find("\\-", at)) plain.erase(at, 1);
    ASSERT_GT(commands().size(), 10u);
    for (const std::string& command : commands()) {
        EXPECT_NE(plain.find(".SS patency " + command), plain.npos) << command;
        const std::set<std::string> options = matches(patency(command + " --help").output, "(--[a-z-]+)");
        for (const std::string& option : options)
            if (option != "--help") {
                EXPECT_NE(plain.find(option), plain.npos) << command << ' ' << option;
            }
    }
    EXPECT_NE(plain.find("143"), plain.npos);
}

TEST(Documents, NoLineOfTheManualIsTakenForARequest) {
    static const std::set<std::string> requests{".TH", ".SH", ".SS", ".TP", ".B", ".I"};
    std::istringstream lines(patency("man").output);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && (line[0] == '.' || line[0] == '\'')) {
            EXPECT_TRUE(requests.count(line.substr(0, line.find(' ')))) << line;
        }
}

/// What bash offers in an empty folder for words of which the last is being written.
std::string offered(const std::string& words, int at) {
    const std::string script = fmt::format(
        "cd $(mktemp -d); trap 'rmdir $PWD' EXIT; source <('{}' completion bash); COMP_WORDS=({}); COMP_CWORD={}; "
        "_patency; echo \"${{COMPREPLY[*]}}\"",
        PATENCY_BINARY, words, at);
    std::FILE* pipe =
        popen(fmt::format("bash -c {}", "'" + std::regex_replace(script, std::regex("'"), "'\\''") + "'").c_str(), "r");
    std::string output;
    char chunk[4096];
    while (const std::size_t n = std::fread(chunk, 1, sizeof chunk, pipe)) output.append(chunk, n);
    EXPECT_EQ(pclose(pipe), 0) << script;
    return output;
}

TEST(Documents, BashCompletesCommandsOptionsAndFiles) {
    EXPECT_EQ(offered("patency es", 1), "estimate\n");
    EXPECT_EQ(offered("patency flow a.yaml --thr", 3), "--threads\n");
    EXPECT_EQ(offered("patency stent li", 2), "list\n");
    EXPECT_NE(offered("patency check /et", 2).find("/etc"), std::string::npos);
    const std::string all = offered("patency \"\"", 1);
    for (const std::string& command : commands()) EXPECT_NE(all.find(command), all.npos) << command;
}

/// The body of a function of the completion, or nothing.
std::string zsh_function(const std::string& completion, const std::string& name) {
    const std::size_t begin = completion.find("\n" + name + "() {\n");
    return begin == completion.npos ? "" : completion.substr(begin + 1, completion.find("\n}\n", begin) - begin);
}

TEST(Documents, ZshCompletesCommandsOptionsWordsAndFiles) {
    const Result result = patency("completion zsh");
    ASSERT_EQ(result.exit_code, 0);
    const std::string& zsh = result.output;
    EXPECT_TRUE(zsh.starts_with("#compdef patency\n"));
    const std::string program = zsh_function(zsh, "_patency");
    for (const std::string& command : commands()) {
        EXPECT_NE(program.find("\n        '" + command + ":"), program.npos) << command;
        const std::string own = zsh_function(zsh, "_patency_" + command);
        ASSERT_FALSE(own.empty()) << command;
        const std::set<std::string> options = matches(patency(command + " --help").output, "\n  (?:-.,)?(--[a-z-]+)");
        EXPECT_TRUE(options.count("--help")) << command;
        EXPECT_EQ(matches(own, "\n        '(?:\\*|\\([^)]*\\))?(--[a-z-]+)=?\\["), options) << own;
    }
    EXPECT_NE(zsh_function(zsh, "_patency_verify").find(":(quick full)'"), zsh.npos);
    EXPECT_NE(zsh_function(zsh, "_patency_flow").find("'*--set=["), zsh.npos) << "may be repeated";
    EXPECT_NE(zsh_function(zsh, "_patency_flow").find("':case:_files'"), zsh.npos);
    EXPECT_NE(zsh_function(zsh, "_patency_stent_show").find("--turn="), zsh.npos);
}

TEST(Documents,
     NoTextOfAnOptionEndsItsWordOfZsh) {   // an apostrophe would end it, a bracket the text, a colon the command
    std::istringstream lines(patency("completion zsh").output);
    int checked = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("        '")) continue;
        ++checked;
        const std::string closed = std::regex_replace(line, std::regex(R"('\\'')"), "");
        EXPECT_EQ(std::count(closed.begin(), closed.end(), '\''), 2) << line;
        const std::string plain = std::regex_replace(closed, std::regex(R"(\\.)"), "");
        EXPECT_LE(std::count(plain.begin(), plain.end(), '['), 1) << line;
        EXPECT_EQ(std::count(plain.begin(), plain.end(), '['), std::count(plain.begin(), plain.end(), ']')) << line;
    }
    EXPECT_GT(checked, 100);
}

}   // namespace
}   // namespace patency
