import type { commissionEn } from "./commission_en";
import { dangerCs } from "./danger_words";

/** The words of commissioning in Czech. */
export const commissionCs: Record<keyof typeof commissionEn, string> = {
    "commission.title": "Uvedení do provozu",
    "commission.about": "ruční pojezd, rampy, polohy, spínače",
    ...dangerCs("STOP"),
    "commission.motor": "Motor",
    "commission.acts": "Ruční pojezd motoru",
    "commission.hold": "Jede, dokud je stisknuto: myší, prstem, mezerníkem nebo šipkami",
    "commission.back": "◀ držet: vzad",
    "commission.forth": "držet: vpřed ▶",
    "commission.position": "Poloha motoru",
    "commission.unknown": "–",
    "commission.farthest": "Nejvýše kroků",
    "commission.step": "Krok po",
    "commission.stepBack": "− krok",
    "commission.stepForth": "+ krok",
    "commission.stepLabel": "Jeden pohyb o tolik kroků",
    "commission.zero": "Zde je 0",
    "commission.zeroLabel": "Pošle C100: čítač polohy bude 0; nic se nepohne",
    "commission.letGo":
        "Puštění zastaví motor po rampě; stejně tak opuštění tlačítka nebo tohoto okna a jednotka, která se odmlčí. Když "
        + "služba o této stránce 0,7 s neslyší, zastaví všechny motory. Bez služby, kdy má sériový port sama tato stránka, "
        + "zastaví všechny motory i zavření stránky, ale nikdo nevidí, zda zastavily; a nikdo je nezastaví, když stránku "
        + "ukončí prohlížeč nebo počítač, nebo po vytažení kabelu.",
    "commission.reach": "Pak motor dojede tento pojezd do konce, nejvýše {steps} kroků.",
    "commission.noReach": "Pak motor jede dál BEZ KONCE: použijte nouzové tlačítko. (Nejvýše 0 znamená: bez omezení.)",
    "commission.forgets":
        "Program motoru v jednotce se svými hlídači a total stopy bude zapomenut, ne však ten ve Flash.",
    "commission.notKnown": "Nelze: není známo, co motor teď dělá.",
    "commission.original": "Nelze: tato jednotka neříká, co její motory dělají (Get Status).",
    "commission.stopOpen": "Nelze: STOP není potvrzen.",
    "commission.runs": "Nelze, dokud motor vykonává program: nejdříve STOP.",
    "commission.left":
        "V motoru {motor} může být zbytek posledního pojezdu: Pokračovat C75 by v něm pokračovalo. Nejdříve stiskněte Reset.",
    "commission.teach": "Naučit: tuto polohu do programu",
    "commission.teachLabel": "Vloží příkaz, který jede na současnou polohu, na místo kurzoru v programu",
    "commission.taught": "{command} je v programu",
    "commission.negative":
        "Na polohu pod 0 žádný příkaz nejede: nastavte polohu 0 na nejnižším místě (Zde je 0) a naučte ji znovu.",
    "commission.backward": "vzad",
    "commission.forward": "vpřed",
    "ramp.start": "Start/Stop rychlost S",
    "ramp.speed": "Rychlost V, kroků/s",
    "ramp.ramp": "Rampa A, kroků/s²",
    "ramp.trial": "pro pohyb o",
    "ramp.insert": "S V A do programu",
    "ramp.reached":
        "Rozjede se hned rychlostí S, {start} kroků/s, a {speed} kroků/s dosáhne po {seconds} s a {steps} krocích; brzdění "
        + "trvá stejně: tak daleko ještě dojede po zastavení.",
    "ramp.lower": "{trial} kroků je pro V málo: nejvyšší rychlost je {speed} kroků/s, po {seconds} s a {steps} krocích.",
    "ramp.whole": "Pohyb o {trial} kroků trvá {whole} s.",
    "ramp.long": "Pohyb trvá déle než 60 s.",
    "ramp.unknown": "Co rampa znamená, není známo: simulátor neodpovídá nebo chybí číslo.",
    "homing.run": "Hledat spínač",
    "homing.back": "vzad, (",
    "homing.forth": "vpřed, )",
    "homing.input": "Vstup",
    "homing.speedField": "Rychlost S",
    "homing.away": "0 je vzdálena",
    "homing.twice": "dvakrát, podruhé pomalu",
    "homing.insert": "Hledání do programu",
    "homing.done": "Je v programu; nic nebylo odesláno",
    "homing.speed": "S je rychlost hledání",
    "homing.search": "{side}, dokud vstup {input} není 1, pak hned stop",
    "homing.leave": "sjet ze spínače",
    "homing.again": "ještě jednou pomalu",
    "homing.here": "toto je poloha spínače",
    "homing.zero": "poloha 0",
};
