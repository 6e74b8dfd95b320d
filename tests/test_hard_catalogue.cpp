// The hard cases whose answers are exact, in every number system; tests/firmware/test_catalogue.py runs the
// same on boards.
#include "hard_catalogue.hpp"
#include "number_helpers.hpp"

namespace {

using namespace qray::test;

template <class N>
struct Catalogue : ::testing::Test {};
TYPED_TEST_SUITE(Catalogue, NumberSystems, SystemNames);

#define QRAY_TEST(name)                                                                                 \
    TYPED_TEST(Catalogue, name)                                                                         \
    {                                                                                                   \
        catalogue::Check check;                                                                         \
        catalogue::name<TypeParam>(check);                                                              \
        EXPECT_GT(check.checks, 0u);                                                                    \
        EXPECT_EQ(check.failures, 0u) << "first in line " << check.first;                               \
    }
QRAY_CATALOGUE(QRAY_TEST)

} // namespace
