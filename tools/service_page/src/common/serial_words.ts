import type { Translate } from "../language";

/** Words of serial ports that the browser opens, for the pages of all units. */
export const serialEn = {
    "port.choose": "serial port: the browser asks which …",
    "serial.notChosen": "no port was chosen ({cause})",
    "serial.notChosenNext": "press Connect, and choose one",
    "serial.notOpened": "{port} cannot be opened ({cause})",
    "serial.notOpenedNext":
        "another program, or another page, may have it open: end that and connect again; if not, check the cable, and "
        + "on Linux whether you may use the port (group dialout)",
    "serial.unplugged": "unplugged",
    "serial.lost": "{port} was lost ({cause}); what the unit does now is not known",
    "serial.lostNext": "check the cable, then connect again; nothing that was asked for meanwhile is done later",
};

export const serialCs: Record<keyof typeof serialEn, string> = {
    "port.choose": "sériový port: prohlížeč se zeptá který …",
    "serial.notChosen": "nebyl vybrán žádný port ({cause})",
    "serial.notChosenNext": "stiskněte Připojit a vyberte jej",
    "serial.notOpened": "{port} nelze otevřít ({cause})",
    "serial.notOpenedNext":
        "možná jej má otevřený jiný program nebo jiná stránka: ukončete je a připojte se znovu; jinak zkontrolujte kabel "
        + "a v Linuxu právo k portu (skupina dialout)",
    "serial.unplugged": "odpojen",
    "serial.lost": "spojení přes {port} se přerušilo ({cause}); co jednotka teď dělá, není známo",
    "serial.lostNext": "zkontrolujte kabel a připojte se znovu; co bylo zadáno mezitím, se nestane ani později",
};

/** `serial.none`: there are none, and what to use instead. */
export type SerialWords = Translate<keyof typeof serialEn | "serial.none">;
