// The corpus of the fuzzer, once more: every accepted input is built and drawn in every number system, every other
// one gets its one line of error. With sanitizers this is what `make fuzz` looks for.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fuzz/fuzz_scene.cpp"

namespace {

TEST(FuzzCorpus, IsReplayed)
{
    const auto folder = std::filesystem::path(__FILE__).parent_path() / "fuzz" / "corpus";
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string text((std::istreambuf_iterator<char>(in)), {});
        SCOPED_TRACE(entry.path().string());
        EXPECT_EQ(LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(text.data()), text.size()), 0);
        files++;
    }
    EXPECT_GE(files, 300);
}

} // namespace
