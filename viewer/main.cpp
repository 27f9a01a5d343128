// SPDX-License-Identifier: Apache-2.0

// The program osd_shading_viewer: a window on subdivision shading, and pictures of it without a window.

#include <opensubdiv/far/error.h>
#include <signal.h>

#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "commandLine.h"
#include "figures.h"
#include "imageMaker.h"
#include "window.h"

namespace osd_shading::viewer {

namespace {

constexpr int kSuccess = 0, kFailure = 2;

// One line, whatever the text: scripts read it as such.
void PrintLine(char const* kind, std::string text) {
    for (char& c : text) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    std::fprintf(stderr, "osd_shading_viewer: %s: %s\n", kind, text.c_str());
}

void PrintOpenSubdivWarning(char const* text) { PrintLine("warning", std::string("OpenSubdiv: ") + text); }

int MakeImage(CommandLine const& line) {
    ImageMaker maker;
    WritePng(line.imageFile, maker.Make(line, [](std::string const& warning) { PrintLine("warning", warning); }));
    return kSuccess;
}

int Run(std::vector<std::string> const& words) {
    std::optional<CommandLine> const line = ParseCommandLine(words);
    if (!line) return kSuccess;
    Far::SetWarningCallback(PrintOpenSubdivWarning);
    if (!line->imageFile.empty()) return MakeImage(*line);
    if (!line->figuresFolder.empty()) {
        OffscreenContext const context;
        for (std::string const& file : WriteFigures(line->figuresFolder, line->extraModels, line->scale)) {
            std::puts(file.c_str());
        }
        return kSuccess;
    }
    RunWindow(*line);
    return kSuccess;
}

}  // namespace

}  // namespace osd_shading::viewer

int main(int argc, char** argv) {
    using namespace osd_shading::viewer;
    // A pipe that closes is an error of the write, not the end.
    signal(SIGPIPE, SIG_IGN);
    try {
        return Run(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
    } catch (std::bad_alloc const&) {
        PrintLine("error", "out of memory; a lower --level takes a quarter");
    } catch (std::exception const& error) {
        PrintLine("error", error.what());
    }
    return kFailure;
}
