"""Where members of a C variable are, from the debug information of an ELF file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from elftools.dwarf.die import DIE
from elftools.elf.elffile import ELFFile


def bare(die: DIE) -> DIE:
    """A structure after its other names."""
    while die.tag in ("DW_TAG_typedef", "DW_TAG_const_type", "DW_TAG_volatile_type"):
        die = die.get_DIE_from_attribute("DW_AT_type")
    return die


def member(die: DIE, name: str) -> DIE:
    for child in bare(die).iter_children():
        if child.tag == "DW_TAG_member" and child.attributes["DW_AT_name"].value == name.encode():
            return child
    raise LookupError(name)


def find_struct(elf: ELFFile, name: str) -> DIE:
    for unit in elf.get_dwarf_info(relocate_dwarf_sections=False).iter_CUs():
        for die in unit.iter_DIEs():
            if die.tag == "DW_TAG_structure_type" and "DW_AT_byte_size" in die.attributes:
                named = die.attributes.get("DW_AT_name")
                if named is not None and named.value == name.encode():
                    return die
    raise LookupError(name)


def offset(elf: Path, struct: str, path: Sequence[str]) -> int:
    """Bytes from the begin of a structure to a member of a member."""
    bytes_before = 0
    with elf.open("rb") as file:
        die = find_struct(ELFFile(file), struct)
        for name in path:
            found = member(die, name)
            bytes_before += found.attributes["DW_AT_data_member_location"].value
            die = found.get_DIE_from_attribute("DW_AT_type")
    return bytes_before
