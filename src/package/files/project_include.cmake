# ESP-IDF reads this before all components.
include(${CMAKE_CURRENT_LIST_DIR}/qrayConfig.cmake)
