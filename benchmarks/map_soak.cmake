# A long drive through a map with a tenth of its memory, and what a frame costs in maps of all sizes.
add_executable(map_soak map_soak.cpp map_engine_world.cpp)
target_link_libraries(map_soak PRIVATE
  stereovox::occupancy stereovox_build_options fmt::fmt CLI11::CLI11)
add_executable(map_growth map_growth.cpp map_engine_world.cpp)
target_link_libraries(map_growth PRIVATE
  stereovox::occupancy stereovox_build_options fmt::fmt CLI11::CLI11)
