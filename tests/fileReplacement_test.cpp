// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/fileReplacement.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <future>
#include <string>

#include "ioFiles.h"
#include "osd_shading/io/errors.h"

using namespace osd_shading;
using namespace osd_shading::io;
using ioFiles::ErrorOf;
using ioFiles::ReadBytes;
using ioFiles::TemporaryFolder;
using ioFiles::WriteBytes;
namespace fs = std::filesystem;

namespace {

void writeFile(std::string const& path, std::string const& bytes) {
    FileReplacement file(path);
    file.Write(bytes.data(), bytes.size());
    file.Commit();
}

std::string errorOf(std::string const& path, std::string const& bytes) {
    return ErrorOf<WriteError>([&] { writeFile(path, bytes); });
}

unsigned modeOf(std::string const& path) { return static_cast<unsigned>(fs::status(path).permissions()); }

// Whether `action` returns true in a child process, so that limits and signals stay there.
template <typename Action>
bool isTrueInChild(Action const& action) {
    pid_t const child = fork();
    if (child == 0) _exit(action() ? 0 : 1);
    int status = -1;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

TEST(FileReplacement, WhatIsWrittenStandsInTheFileAfterCommit) {
    TemporaryFolder const folder;
    std::string const path = folder.File("out");
    std::string large;
    for (int i = 0; i < 700000; ++i) large += std::to_string(i) + '\n';  // several buffers
    {
        FileReplacement file(path);
        for (std::size_t at = 0, size = 1; at < large.size(); at += size, size = size * 3 % 100003 + 1) {
            size = std::min(size, large.size() - at);
            file.Write(large.data() + at, size);
        }
        file.Write(nullptr, 0);
        file.Commit();
    }
    EXPECT_EQ(ReadBytes(path), large);
    EXPECT_EQ(folder.NumFiles(), 1u);
    writeFile(path, large + large);
    EXPECT_EQ(ReadBytes(path).size(), 2 * large.size());
    writeFile(path, "");
    EXPECT_EQ(ReadBytes(path), "");
}

TEST(FileReplacement, WithoutCommitTheOldFileStaysAndNothingElse) {
    TemporaryFolder const folder;
    WriteBytes(folder.File("out"), "old");
    {
        FileReplacement file(folder.File("out"));
        std::string const bytes(3000000, 'x');
        file.Write(bytes.data(), bytes.size());
        EXPECT_EQ(folder.NumFiles(), 2u);
    }
    EXPECT_EQ(ReadBytes(folder.File("out")), "old");
    EXPECT_EQ(folder.NumFiles(), 1u);
}

TEST(FileReplacement, ANewFileFollowsTheUmaskAndAReplacedOneKeepsItsPermissions) {
    TemporaryFolder const folder;
    std::string const path = folder.File("out");
    mode_t const umaskBefore = umask(027);
    writeFile(path, "a");
    umask(umaskBefore);
    EXPECT_EQ(modeOf(path), 0640u);
    fs::permissions(path, fs::perms(0604));
    writeFile(path, "b");
    EXPECT_EQ(modeOf(path), 0604u);
    EXPECT_EQ(ReadBytes(path), "b");
}

TEST(FileReplacement, ALinkStaysAndWhatItPointsToIsReplaced) {
    TemporaryFolder const folder;
    fs::create_directory(folder.File("deep"));
    WriteBytes(folder.File("deep/target"), "old");
    fs::create_symlink("deep/target", folder.File("link"));
    fs::create_symlink("link", folder.File("linkToLink"));
    writeFile(folder.File("linkToLink"), "new");
    EXPECT_TRUE(fs::is_symlink(folder.File("link")));
    EXPECT_TRUE(fs::is_symlink(folder.File("linkToLink")));
    EXPECT_EQ(ReadBytes(folder.File("deep/target")), "new");
    EXPECT_FALSE(fs::is_symlink(folder.File("deep/target")));

    fs::create_symlink("deep/later", folder.File("dangling"));
    writeFile(folder.File("dangling"), "made");
    EXPECT_EQ(ReadBytes(folder.File("deep/later")), "made");

    fs::create_symlink("loop", folder.File("loop"));
    EXPECT_EQ(errorOf(folder.File("loop"), ""),
              folder.File("loop") + ": can't be written: Too many levels of symbolic links");
}

TEST(FileReplacement, ANameOfFullLengthLeavesRoomForTheTemporaryFile) {
    TemporaryFolder const folder;
    std::string const path = folder.File(std::string(255, 'n'));
    writeFile(path, "x");
    EXPECT_EQ(ReadBytes(path), "x");
}

TEST(FileReplacement, APathWithoutFolderIsInTheCurrentOne) {
    TemporaryFolder const folder;
    EXPECT_TRUE(isTrueInChild([&] {
        if (chdir(folder.Path().c_str()) != 0) return false;
        writeFile("out", "here");
        return true;
    }));
    EXPECT_EQ(ReadBytes(folder.File("out")), "here");
    EXPECT_EQ(folder.NumFiles(), 1u);
}

TEST(FileReplacement, DevicesAndPipesAreWrittenDirectly) {
    writeFile("/dev/null", "nothing");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));

    TemporaryFolder const folder;
    std::string const pipe = folder.File("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    auto reader = std::async(std::launch::async, [&] { return ReadBytes(pipe); });
    std::string const bytes(200000, 'p');  // more than a pipe holds
    writeFile(pipe, bytes);
    EXPECT_EQ(reader.get(), bytes);
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_EQ(folder.NumFiles(), 1u);
}

TEST(FileReplacement, StandardOutputIsWrittenWhereItStandsAlsoWhenItIsAFile) {
    TemporaryFolder const folder;
    std::string const path = folder.File("redirected");
    for (char const* const name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
        EXPECT_TRUE(isTrueInChild([&] {
            int const file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
            if (dup2(file, 1) != 1 || write(1, "before ", 7) != 7) return false;
            writeFile(name, "between");
            return write(1, " after", 6) == 6;
        })) << name;
        EXPECT_EQ(ReadBytes(path), "before between after") << name;
    }
    EXPECT_EQ(folder.NumFiles(), 1u);
}

TEST(FileReplacement, WhatCannotBeWrittenSaysWhy) {
    TemporaryFolder const folder;
    EXPECT_EQ(errorOf(folder.Path(), ""), folder.Path() + ": can't be written: it is a folder, not a file");
    EXPECT_EQ(errorOf(folder.File("no/out"), ""),
              folder.File("no/out") + ": can't be written: No such file or directory");
    WriteBytes(folder.File("file"), "");
    EXPECT_EQ(errorOf(folder.File("file/out"), ""),
              folder.File("file/out") + ": can't be written: Not a directory");
    EXPECT_EQ(errorOf("", ""), "'': can't be written: the name of the file is empty");
    EXPECT_EQ(folder.NumFiles(), 1u);
}

TEST(FileReplacement, AFullDiskIsAnError) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    EXPECT_EQ(errorOf("/dev/full", "x"), "/dev/full: can't be written: No space left on device");
    EXPECT_EQ(errorOf("/dev/full", std::string(5000000, 'x')),
              "/dev/full: can't be written: No space left on device");
}

TEST(FileReplacement, AFileWithoutPermissionIsNotReplaced) {
    TemporaryFolder const folder;
    std::string const path = folder.File("out");
    WriteBytes(path, "old");
    fs::permissions(path, fs::perms(0444));
    fs::permissions(folder.Path(), fs::perms(0777));
    // Root may write everything; so become somebody who may not.
    auto const isRefused = [](std::string const& file) {
        constexpr uid_t kNobody = 65534;
        if (geteuid() == 0 && setuid(kNobody) != 0) return false;
        return errorOf(file, "new") == file + ": can't be written: Permission denied";
    };
    EXPECT_TRUE(isTrueInChild([&] { return isRefused(path); }));
    fs::permissions(folder.Path(), fs::perms(0555));
    EXPECT_TRUE(isTrueInChild([&] { return isRefused(folder.File("other")); }));
    fs::permissions(folder.Path(), fs::perms(0700));
    EXPECT_EQ(ReadBytes(path), "old");
    EXPECT_EQ(folder.NumFiles(), 1u);
}

TEST(FileReplacement, BeyondTheProcessesLimitIsAnErrorWhetherItsSignalIsIgnoredOrNot) {
    for (bool const isIgnored : {true, false}) {
        TemporaryFolder const folder;
        WriteBytes(folder.File("out"), "old");
        EXPECT_TRUE(isTrueInChild([&] {
            rlimit const limit = {100000, 100000};
            setrlimit(RLIMIT_FSIZE, &limit);
            std::signal(SIGXFSZ, isIgnored ? SIG_IGN : SIG_DFL);
            return errorOf(folder.File("out"), std::string(150000, 'x')) ==
                       folder.File("out") + ": can't be written: File too large" &&
                   errorOf(folder.File("out"), std::string(3000000, 'x')) != "";
        })) << isIgnored;
        EXPECT_EQ(ReadBytes(folder.File("out")), "old");
        EXPECT_EQ(folder.NumFiles(), 1u);
    }
}

TEST(FileReplacement, APipeThatNobodyReadsAnyMoreIsAnErrorNotASignal) {
    EXPECT_TRUE(isTrueInChild([&] {
        int ends[2];
        if (pipe(ends) != 0) return false;
        close(ends[0]);
        std::signal(SIGPIPE, SIG_DFL);
        std::string const path = "/dev/fd/" + std::to_string(ends[1]);
        return errorOf(path, "x") == path + ": can't be written: Broken pipe";
    }));
}

TEST(FileReplacement, TwoWritersOfOneFileDoNotMix) {
    TemporaryFolder const folder;
    std::string const path = folder.File("out");
    FileReplacement one(path), other(path);
    std::string const a(2000000, 'a'), b(1500000, 'b');
    one.Write(a.data(), a.size());
    other.Write(b.data(), b.size());
    other.Commit();
    EXPECT_EQ(ReadBytes(path), b);
    one.Commit();
    EXPECT_EQ(ReadBytes(path), a);
    EXPECT_EQ(folder.NumFiles(), 1u);
}
