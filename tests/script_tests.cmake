# Tests of the whole program, as scripts: SCRIPT PROGRAM SHOT. All but one are slow. 77 means skipped.
function(ft_script_test name script)
  if(TARGET followthrough AND EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${script})
    add_test(NAME ${name} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/${script} $<TARGET_FILE:followthrough> ${ARGN})
    set_tests_properties(${name} PROPERTIES LABELS slow SKIP_RETURN_CODE 77 TIMEOUT 1800)
    if(FOLLOWTHROUGH_SANITIZE STREQUAL "thread")  # slowest of all: every 31st call fails instead of every one, 6 kills for 25
      set_tests_properties(${name} PROPERTIES TIMEOUT 3600 ENVIRONMENT "STEP=31;KILLS=6")
    elseif(FOLLOWTHROUGH_SANITIZE)
      set_tests_properties(${name} PROPERTIES TIMEOUT 3600 ENVIRONMENT STEP=11)
    endif()
  endif()
endfunction()

set(small_shot ${CMAKE_CURRENT_SOURCE_DIR}/data/small_shot/shot.toml)
ft_script_test(determinism baker/determinism.sh ${small_shot})
ft_script_test(kill_resume baker/kill_resume.sh ${small_shot})
if(NOT FOLLOWTHROUGH_SANITIZE)  # which takes several times the memory
  ft_script_test(memory baker/memory.sh)
endif()
# Some 330 bakes: little work in each, what counts is what is written.
ft_script_test(failing_writes baker/failing_writes.sh ${small_shot} --set shot.preroll=1 --set solver.newton_iterations=1
  --set solver.min_substeps=1 --set solver.max_substeps=2 --set primary.walker.speed=0.2)
if(TARGET failing_write AND TEST failing_writes)
  set_property(TEST failing_writes APPEND PROPERTY ENVIRONMENT FT_FAILING_WRITE=$<TARGET_FILE:failing_write>)
endif()
ft_script_test(documents documents.sh)
if(TEST documents)
  set_tests_properties(documents PROPERTIES LABELS "")  # done in a second
endif()
ft_script_test(crashers crashers.sh)
if(NOT FOLLOWTHROUGH_SANITIZE)
  ft_script_test(pinned pinned.sh "${CMAKE_CXX_COMPILER_ID}-${CMAKE_CXX_COMPILER_VERSION} ${FOLLOWTHROUGH_MARCH}")
endif()
ft_script_test(variants samples/variants.sh)
ft_script_test(vest samples/vest.sh)
ft_script_test(install install/install_test.sh ${CMAKE_BINARY_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/data/small_shot/skirt.obj ${CMAKE_CXX_COMPILER})
# A bake under a sanitizer takes many times as long.
if(TARGET sweep_tool AND TARGET make_garments AND NOT FOLLOWTHROUGH_SANITIZE)
  ft_script_test(sweep bench/sweep_test.sh)
  if(TEST sweep)
    set_tests_properties(sweep PROPERTIES PROCESSORS 2)
  endif()
endif()
