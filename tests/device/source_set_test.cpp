// Includes expanded on the host, and build logs that name real files and lines.
#include "host/base/error.h"
#include "host/device/program.h"
#include "tests/device/failure_text.h"
#include "tests/device/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace clshade {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::failure_text;
using tests::TemporaryFolder;

std::size_t count(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++found;
    }
    return found;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << text;
}

TEST(SourceSet, ExpandsNestedIncludesOnce) {
    SourceSet set;
    set.add("main.cl", "#include \"a.h\"\n  #  include\t\"b.h\" // again\nint m;\n");
    set.add("a.h", "#pragma once\n#include \"b.h\"\nint a;\n");
    set.add("b.h", "int b;");
    const std::string text = set.expand("main.cl");
    EXPECT_EQ(count(text, "int b;"), 1U);
    EXPECT_EQ(count(text, "int a;"), 1U);
    EXPECT_EQ(count(text, "#pragma once"), 0U);
    EXPECT_EQ(count(text, "include"), 0U);
    EXPECT_LT(text.find("int b;"), text.find("int a;"));
    EXPECT_LT(text.find("int a;"), text.find("int m;"));
}

TEST(SourceSet, LineDirectivesSpeakOfThePathGiven) {
    SourceSet set;
    set.add("main.cl", "int first;\n#include \"a.h\"\nint third;\n");
    set.add("a.h", "int a;\n", "/home/me/my \"kernels\"/a.h");
    const std::string text = set.expand("main.cl");
    EXPECT_THAT(text, HasSubstr("#line 1 \"main.cl\"\nint first;\n"));
    EXPECT_THAT(text, HasSubstr("#line 1 \"/home/me/my \\\"kernels\\\"/a.h\"\nint a;\n"));
    EXPECT_THAT(text, HasSubstr("#line 3 \"main.cl\"\nint third;\n"));
}

TEST(SourceSet, CirclesEnd) {
    SourceSet set;
    set.add("main.cl", "#include \"a.h\"\n");
    set.add("a.h", "#include \"b.h\"\nint a;\n");
    set.add("b.h", "#include \"a.h\"\n#include \"main.cl\"\n#include \"b.h\"\nint b;\n");
    const std::string text = set.expand("main.cl");
    EXPECT_EQ(count(text, "int a;"), 1U);
    EXPECT_EQ(count(text, "int b;"), 1U);
    set.add("c.cl", "#if 0\n#include \"c.cl\"\n#endif\n#ifdef X\n#include \"c.cl\"\n#endif\nint c;\n");
    EXPECT_EQ(count(set.expand("c.cl"), "int c;"), 1U);
}

TEST(SourceSet, CommentsAndForeignIncludesStay) {
    SourceSet set;
    set.add("main.cl",
            "/* see\n#include \"gone.h\"\n*/\n// #include \"gone.h\"\n#include <system.h>\nchar* s = \"/*\";\n"
            "#include \"a.h\"\n");
    set.add("a.h", "int a;\n");
    const std::string text = set.expand("main.cl");
    EXPECT_EQ(count(text, "gone.h"), 2U);
    EXPECT_EQ(count(text, "#include <system.h>"), 1U);
    EXPECT_EQ(count(text, "int a;"), 1U);
}

TEST(SourceSet, CarriageReturnsDoNoHarm) {
    SourceSet set;
    set.add("main.cl", "#include \"a.h\"\r\n#include \"a.h\"\r\nint m;\r\n");
    set.add("a.h", "#pragma once\r\n#if 1\r\nint a;\r\n#endif\r\n");
    const std::string text = set.expand("main.cl");
    EXPECT_EQ(count(text, "int a;"), 1U);
    EXPECT_EQ(count(text, "pragma"), 0U);
}

TEST(SourceSet, MissingIncludeNamesWhoAsks) {
    SourceSet set;
    set.add("main.cl", "\n#include \"a.h\"\n");
    set.add("a.h", "\n\n#include \"typo.h\"\n", "dir/a.h");
    EXPECT_THAT(failure_text([&] { static_cast<void>(set.expand("main.cl")); }),
                AllOf(HasSubstr("dir/a.h:3:"), HasSubstr("\"typo.h\""), HasSubstr("main.cl")));
    EXPECT_THAT(failure_text([&] { static_cast<void>(set.expand("other.cl")); }), HasSubstr("\"other.cl\""));
    EXPECT_THROW(static_cast<void>(set.text("other.cl")), RuntimeFailure);
}

TEST(SourceSet, FolderReplacesAndAdds) {
    const TemporaryFolder folder;
    write_file(folder.path() / "a.h", "int mine;\n");
    write_file(folder.path() / "extra.cl", "int extra;\n");
    write_file(folder.path() / "notes.txt", "no source");
    SourceSet set;
    set.add("main.cl", "#include \"a.h\"\n");
    set.add("a.h", "int yours;\n");
    set.override_from(folder.path());
    EXPECT_THAT(set.names(), ElementsAre("a.h", "extra.cl", "main.cl"));
    EXPECT_THAT(set.expand("main.cl"), AllOf(HasSubstr("int mine;"), Not(HasSubstr("int yours;")),
                                             HasSubstr("#line 1 \"" + (folder.path() / "a.h").string() + "\"")));
}

TEST(SourceSet, FolderThatHelpsNothingIsAUsageError) {
    const TemporaryFolder folder;
    SourceSet set;
    set.add("main.cl", "");
    EXPECT_THROW(set.override_from(folder.path() / "absent"), UsageError);
    EXPECT_THROW(set.override_from(folder.path()), UsageError);
    write_file(folder.path() / "other.cl", "");
    EXPECT_THAT(failure_text([&] { set.override_from(folder.path()); }),
                AllOf(HasSubstr(folder.path().string()), HasSubstr("main.cl")));
    EXPECT_FALSE(set.contains("other.cl"));
}

std::string build_failure(const SourceSet& set, const std::string& options = {}) {
    Device device(select_device(list_devices(), "cpu"));
    return failure_text([&] { const Program program(device, set, "main.cl", options, ProgramCache::disabled()); });
}

/// The compiler sees what the host expanded: one definition of each, whichever branch is taken.
TEST(SourceSet, IncludesUnderConditionsBuild) {
    SourceSet set;
    set.add("main.cl", "#ifdef ABSENT\n#include \"a.h\"\n#endif\n#ifndef ABSENT\n#include \"a.h\"\n#endif\n"
                       "#include \"a.h\"\n__kernel void k(__global int* o) { o[0] = a(); }\n");
    set.add("a.h", "int a(void) { return 1; }\n");
    EXPECT_EQ(build_failure(set), "nothing was thrown");
    EXPECT_EQ(build_failure(set, "-DABSENT"), "nothing was thrown");
}

TEST(BuildLog, NamesFileAndLineOfAnIncludedError) {
    SourceSet set;
    set.add("main.cl", "// one\n#include \"maths.h\"\n__kernel void k(__global float* o) { o[0] = f(); }\n");
    set.add("maths.h", "// one\n// two\nfloat f(void) { return undeclared_name; }\n", "kernels/maths.h");
    const std::string text = build_failure(set, "-DSOME_OPTION=1");
    EXPECT_THAT(text, AllOf(HasSubstr("kernels/maths.h:3:"), HasSubstr("undeclared_name"), HasSubstr("main.cl"),
                            HasSubstr("-DSOME_OPTION=1"), HasSubstr("-cl-std=CL1.2"),
                            HasSubstr(select_device(list_devices(), "cpu").name)));
}

TEST(BuildLog, NamesFileAndLineAfterAnInclude) {
    SourceSet set;
    set.add("main.cl", "#include \"maths.h\"\n\n__kernel void k(__global float* o) { o[0] = oops; }\n");
    set.add("maths.h", "int a;\nint b;\nint c;\n");
    EXPECT_THAT(build_failure(set), HasSubstr("main.cl:3:"));
}

TEST(BuildLog, LongOnesAreCut) {
    SourceSet set;
    std::string text = "__kernel void k(__global float* o) {\n";
    for (int i = 0; i < 500; ++i) {
        text += "o[" + std::to_string(i) + "] = wrong_" + std::to_string(i) + ";\n";
    }
    set.add("main.cl", text + "}\n");
    const std::string log = build_failure(set);
    EXPECT_THAT(log, HasSubstr("main.cl:2:"));
    EXPECT_LE(count(log, "\n"), 62U);
}

} // namespace
} // namespace clshade
