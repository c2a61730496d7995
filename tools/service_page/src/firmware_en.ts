/** The words of the firmware's update in English. */
export const firmwareEn = {
    "firmware.title": "Firmware",
    "firmware.about": "how it gets into a board",
    "firmware.danger": "Motors unpowered, best disconnected, whenever a board is flashed.",
    "firmware.dangerWords":
        "Its pins do what the loader wants meanwhile. Stored programs stay; what is in the unit's memory only is gone.",
    "firmware.board": "Board",
    "firmware.commands": "Commands, one of them; the first two in a checkout of the project, which builds the image",
    "firmware.page": "What the board's page says",
    "firmware.usb": "From this page, by USB (WebUSB)",
    "firmware.untried":
        "Written from ST's application note AN3156, and tried on a model of the chip's loader only, never on a part. "
        + "Windows needs WinUSB as the driver of the loader, Linux the right to use the device.",
    "firmware.noUsb":
        "This browser does not reach USB devices: take one of the commands, or Chrome, Edge or Opera on a computer.",
    "firmware.file": "Image (.bin)",
    "firmware.confirm": "The motors are unpowered, and the board is in its loader",
    "firmware.write": "Write and start",
    "firmware.done": "{image}: written, read back without a difference, and started.",
    "firmware.image": "{image}, whole.",
    "firmware.otherUnit": "{image}, whole. Mind: an image of ANOTHER UNIT than this page's.",
    "firmware.noImage": "{name}: no image of this project, or not whole, or changed; nothing was written.",
    "firmware.otherBoard": "{name}: this is {image}, no image for {board}; nothing was written.",
    "firmware.unread": "{name}: cannot be read, as it was changed or is away: choose it again; nothing was written.",
    "firmware.notChosen": "No board was chosen; nothing was written.",
    "firmware.noLoader": "This is not the loader of an STM32 with its flash.",
    "firmware.small": "This part has {words} of flash, and stored programs need 1024 kB.",
    "firmware.place": "The image does not fit the sectors of this part.",
    "firmware.busy": "The loader does not come to an end.",
    "firmware.refused": "The loader refuses ({words}).",
    "firmware.differs": "What was read back differs at {words}.",
    "firmware.protected": "The part is protected against reading, so that its loader writes nothing ({words}).",
    "firmware.closed":
        "The board does not open ({words}): another window or program has it, or the system gives no right to use it.",
    "firmware.lost": "The board was lost ({words}).",
    "firmware.half":
        "The image in the board is not whole, or not known to be: "
        + "keep the motors unpowered, start the loader again, and write it again.",
    "firmware.whole":
        "The image is in the board, and was read back without a difference, but is not known to run: "
        + "take the board out of its loader, and reset it.",
    "firmware.nothing": "Nothing was written.",
};
