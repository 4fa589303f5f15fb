# The map engine beside OctoMap; run it without arguments for the whole table.
add_executable(map_engine map_engine.cpp map_engine_world.cpp)
target_link_libraries(map_engine PRIVATE
  stereovox::occupancy stereovox_build_options fmt::fmt CLI11::CLI11 ${OCTOMAP_LIBRARIES})
target_include_directories(map_engine SYSTEM PRIVATE ${OCTOMAP_INCLUDE_DIRS})
