import type { firmwareEn } from "./firmware_en";

/** The words of the firmware's update in Czech. */
export const firmwareCs: Record<keyof typeof firmwareEn, string> = {
    "firmware.title": "Firmware desky",
    "firmware.about": "jak se dostane do desky",
    "firmware.danger": "Při zápisu do desky musí být motory bez napájení, nejlépe odpojené.",
    "firmware.dangerWords":
        "Vývody zatím dělají, co chce zavaděč. Uložené programy zůstanou; co je jen v paměti jednotky, je pryč.",
    "firmware.board": "Deska",
    "firmware.commands": "Příkazy, jeden z nich; první dva ve stažených zdrojích projektu, kde se obraz i sestaví",
    "firmware.page": "Co říká stránka desky",
    "firmware.usb": "Z této stránky přes USB (WebUSB)",
    "firmware.untried":
        "Napsáno podle aplikační poznámky AN3156 firmy ST a vyzkoušeno jen na modelu zavaděče, nikdy na součástce. "
        + "Windows potřebují pro zavaděč ovladač WinUSB, Linux právo zařízení používat.",
    "firmware.noUsb":
        "Tento prohlížeč na zařízení USB nedosáhne: použijte některý z příkazů, nebo Chrome, Edge či Operu na počítači.",
    "firmware.file": "Obraz (.bin)",
    "firmware.confirm": "Motory jsou bez napájení a v desce běží zavaděč",
    "firmware.write": "Zapsat a spustit",
    "firmware.done": "{image}: zapsáno, přečteno zpět beze změny a spuštěno.",
    "firmware.image": "{image}, celý.",
    "firmware.otherUnit": "{image}, celý. Pozor: obraz JINÉ JEDNOTKY, než je tato stránka.",
    "firmware.noImage": "{name}: není to obraz tohoto projektu, nebo není celý či byl změněn; nic nebylo zapsáno.",
    "firmware.otherBoard": "{name}: je to {image}, ne obraz pro {board}; nic nebylo zapsáno.",
    "firmware.unread": "{name}: nelze přečíst, neboť se změnil nebo zmizel: vyberte ho znovu; nic nebylo zapsáno.",
    "firmware.notChosen": "Žádná deska nebyla vybrána; nic nebylo zapsáno.",
    "firmware.noLoader": "Toto není zavaděč STM32 s jeho pamětí Flash.",
    "firmware.small": "Tato součástka má {words} paměti Flash, uložené programy potřebují 1024 kB.",
    "firmware.place": "Obraz se do sektorů této součástky nehodí.",
    "firmware.busy": "Zavaděč nekončí.",
    "firmware.refused": "Zavaděč odmítá ({words}).",
    "firmware.differs": "Přečtené se liší na {words}.",
    "firmware.protected": "Součástka je chráněna proti čtení, její zavaděč proto nic nezapíše ({words}).",
    "firmware.closed":
        "Desku nelze otevřít ({words}): má ji jiné okno nebo program, nebo systém nedává právo ji používat.",
    "firmware.lost": "Spojení s deskou se ztratilo ({words}).",
    "firmware.half": "Obraz v desce není celý, nebo se to neví: nechte motory bez napájení, spusťte znovu zavaděč a zapište znovu.",
    "firmware.whole":
        "Obraz je v desce a byl přečten zpět beze změny, neví se však, zda běží: "
        + "ukončete zavaděč desky a resetujte ji.",
    "firmware.nothing": "Nic nebylo zapsáno.",
};
