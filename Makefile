# The front door: make builds, make test tests, make demo shows. CMake does the work.
#
#   make            build into build/; the program is build/tetcast
#   make demo       render the heat sink to build/demo.png
#   make test       build everything and run all tests
#   make sanitize   the same with address and undefined-behaviour sanitizers, in build/sanitize
#   make valgrind   what needs no GL under Valgrind's memcheck, in build/valgrind
#   make hard       the hard cases at length: 100 million rays, beside VTK's renderers; tables in build/hard-cases
#   make fuzz       FUZZ_SECONDS (60) of random inputs for each part that reads what others wrote; FUZZ_TARGETS=… for some
#   make bench      measure speed, memory and growth, side by side with VTK (12 minutes); results in build/bench/results.json.
#                   BENCH_ARGS=--quick tries it, BENCH_ARGS="--only peers,parts" takes some; --help tells more
#   make docs       the figures in docs/images, docs/performance.md of the last make bench, docs/accuracy.md (20 minutes;
#                   ACCURACY_ARGS=--quick tries it in build/accuracy-quick), and the manual pages as HTML in build/docs
#   make performance  docs/performance.md alone
#   make install    to PREFIX (/usr/local), below DESTDIR
#   make clean
#
# BUILD_TYPE=Debug, JOBS=4, WERROR=ON and CMAKE_ARGS=… are passed on. PACKAGES=no installs no Debian packages.

BUILD_TYPE ?= Release
JOBS       ?= $(shell nproc 2>/dev/null || echo 2)
WERROR     ?= OFF
PREFIX     ?= /usr/local
PACKAGES   ?= yes
CMAKE_ARGS ?=
BENCH_ARGS ?=
ACCURACY_ARGS ?=
FUZZ_SECONDS ?= 60
FUZZ_TARGETS ?= preset options paraview mesh sniff wire reply split

BUILD := build

BASE_PACKAGES := gcc g++ libc6-dev cmake ninja-build pkg-config libvtk9-dev libtet1.5-dev libosmesa6-dev libegl-dev \
	libgl-dev libegl1 libgl1-mesa-dri libopenimageio-dev libpng-dev libglm-dev libjansson-dev libcmocka-dev libexpat1-dev \
	python3 python3-numpy
BENCH_PACKAGES := python3 python3-vtk9 python3-numpy xvfb xauth
WINDOW_PACKAGES := libgtk-4-dev xvfb xauth xdotool imagemagick
VALGRIND_PACKAGES := valgrind
FUZZ_PACKAGES := clang-14 libclang-rt-14-dev
DOCS_PACKAGES := groff gnuplot-nox python3

CONFIGURE = cmake -S . -B $(BUILD) $(if $(wildcard $(BUILD)/CMakeCache.txt),,-G Ninja) \
	-DCMAKE_BUILD_TYPE=$(BUILD_TYPE) -DTC_WERROR=$(WERROR) -DCMAKE_INSTALL_PREFIX=$(PREFIX) $(CMAKE_ARGS)
ifeq ($(PACKAGES),yes)
packages = sh cmake/packages.sh $(1)
else
packages = :
endif

.PHONY: all configure window_packages demo test sanitize valgrind hard fuzz bench docs performance install clean
.DEFAULT_GOAL := all

all: configure
	cmake --build $(BUILD) -j $(JOBS)

# Configuring again takes a moment, so it is done only when a setting differs from the last time.
configure:
	@$(call packages,$(BASE_PACKAGES))
	@mkdir -p $(BUILD)
	@settings='$(BUILD_TYPE) $(WERROR) $(PREFIX) $(CMAKE_ARGS) '"$$(pkg-config --modversion gtk4 2>/dev/null)"; \
	if [ "$$settings" != "$$(cat $(BUILD)/.settings 2>/dev/null)" ] || [ ! -f $(BUILD)/CMakeCache.txt ]; then \
		$(CONFIGURE) && echo "$$settings" >$(BUILD)/.settings; \
	fi

demo: all
	$(BUILD)/tetcast render synth:heatsink --size 1024x768 --azimuth 30 --elevation 28 --color-map Turbo \
		--opacity 12:0.5,75:8 --background 1,1,1 --verify 1024 -o $(BUILD)/demo.png
	@echo "The picture is $(BUILD)/demo.png"

# Before the configuration, which looks for GTK.
window_packages:
	@$(call packages,$(WINDOW_PACKAGES)) || echo "without GTK 4 the window is neither built nor tested" >&2

test: window_packages configure
	@$(call packages,$(FUZZ_PACKAGES)) || echo "without clang the fuzz tests are skipped" >&2
	cmake --build $(BUILD) -j $(JOBS) --target all --target all_tests
	cd $(BUILD) && ctest --output-on-failure -j 2

# RelWithDebInfo: reports name lines.
sanitize:
	@$(call packages,$(BASE_PACKAGES))
	cmake -S . -B $(BUILD)/sanitize $(if $(wildcard $(BUILD)/sanitize/CMakeCache.txt),,-G Ninja) \
		-DCMAKE_BUILD_TYPE=RelWithDebInfo -DTC_SANITIZE=ON -DTC_WERROR=$(WERROR) $(CMAKE_ARGS)
	cmake --build $(BUILD)/sanitize -j $(JOBS) --target all --target all_tests
	sh tests/sanitize.sh $(BUILD)/sanitize 2

valgrind:
	@$(call packages,$(BASE_PACKAGES) $(VALGRIND_PACKAGES))
	cmake -S . -B $(BUILD)/valgrind $(if $(wildcard $(BUILD)/valgrind/CMakeCache.txt),,-G Ninja) \
		-DCMAKE_BUILD_TYPE=RelWithDebInfo -DTC_WERROR=$(WERROR) $(CMAKE_ARGS)
	cmake --build $(BUILD)/valgrind -j $(JOBS) --target all --target all_tests
	sh tests/valgrind.sh $(BUILD)/valgrind

# A context that is missing (77) is skipped. Each step runs whatever the others said.
hard: all
	@$(call packages,$(BENCH_PACKAGES))
	cmake --build $(BUILD) -j $(JOBS) --target hard corrupt
	sh tests/hard/run.sh $(BUILD)

# In build/fuzz, by clang. An input that breaks something stays in build/fuzz/crashes, what is new in build/fuzz/found.
fuzz:
	@$(call packages,$(BASE_PACKAGES) $(FUZZ_PACKAGES))
	WERROR=$(WERROR) sh tests/fuzz/build.sh $(BUILD)/fuzz
	@status=0; for target in $(FUZZ_TARGETS); do \
		sh tests/fuzz/run.sh $(BUILD)/fuzz $$target $(FUZZ_SECONDS) || status=1; \
	done; exit $$status

bench: all
	@$(call packages,$(BENCH_PACKAGES) $(VALGRIND_PACKAGES))
	cmake --build $(BUILD) -j $(JOBS) --target bench_programs
	/usr/bin/python3 tests/bench/bench.py --build $(BUILD) $(BENCH_ARGS)

performance:
	@$(call packages,$(DOCS_PACKAGES))
	/usr/bin/python3 docs/performance.py $(BUILD)/bench/results.json

docs: all performance
	sh docs/figures.sh $(BUILD)/tetcast
	[ ! -x $(BUILD)/tetcast-edit ] || sh docs/window.sh $(BUILD) docs/images/window.png
	/usr/bin/python3 docs/gallery.py $(BUILD)/tetcast
	/usr/bin/python3 docs/plain_png.py docs/images/*.png
	/usr/bin/python3 docs/accuracy.py $(BUILD)/tetcast $(BUILD)/accuracy $(ACCURACY_ARGS)
	@mkdir -p $(BUILD)/docs
	@for page in docs/man/*.1; do \
		html=$(BUILD)/docs/$$(basename $$page .1).html; \
		groff -k -man -Thtml -P-l $$page >$$html.part && mv $$html.part $$html && echo $$html || exit 1; \
	done

install: all
	DESTDIR="$(DESTDIR)" cmake --install $(BUILD)

clean:
	rm -rf $(BUILD)
