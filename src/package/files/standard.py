"""PlatformIO: C++20 for the project that uses qray; of several -std the compiler takes the last."""
Import("env", "projenv")  # noqa: F821
for environment in (env, projenv):  # noqa: F821
    environment.Append(CXXFLAGS=["-std=gnu++20", "-ffp-contract=off"])
