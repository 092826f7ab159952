function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed with ${code}: ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${SCRATCH}/build -D CMAKE_C_COMPILER=${COMPILER}
    -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release -D VERSION=${VERSION})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SAMPLE} ${SCRATCH}/part.stl)
run(${SCRATCH}/build/consumer ${SCRATCH}/part.stl ${SCRATCH}/part.gcode)
run(${prefix}/bin/isoslice --strict -c ${prefix}/share/isoslice/profiles/printers/marlin-220.ini
    ${SCRATCH}/part.stl -o ${SCRATCH}/part.gcode)
run(${prefix}/bin/isoslice --version)
run(${CMAKE_COMMAND} -S ${CONSUMER}/../printer -B ${SCRATCH}/build-printer
    -D CMAKE_C_COMPILER=${COMPILER} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release
    -D VERSION=${VERSION})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build-printer)
run(${SCRATCH}/build-printer/printer)
run(${prefix}/bin/isoprint --quiet ${SCRATCH}/part.gcode --port virtual --virtual speed=0)
run(${prefix}/bin/isoprint-virtual --run ${SCRATCH}/part.gcode --bed 220x220x250)
if(NOT EXISTS ${prefix}/share/man/man1/isoprint.1)
  message(FATAL_ERROR "the manual page of isoprint is not installed")
endif()
file(REMOVE_RECURSE ${SCRATCH})
