// Help on symbols: what one means, in the words of the catalogue, while the mouse is over it, while it has the focus, and after a tap.

const note = document.createElement("div");
note.id = "help";
note.setAttribute("role", "tooltip");
note.hidden = true;
document.body.append(note);

// The symbol that the note explains.
let at = null;

// Gives a symbol its help; none with no words.
export function help(element, words) {
    if (!words) return;
    element.dataset.help = words;
    element.tabIndex = 0;
    element.setAttribute("aria-describedby", note.id);
    if (element === at) note.textContent = words;
}

const of = (event) => event.target.closest?.("[data-help]") ?? null;

function show(element) {
    at = element;
    note.hidden = !element;
    if (!element) return;
    note.textContent = element.dataset.help;
    const { left, top, bottom } = element.getBoundingClientRect();
    const { offsetWidth: width, offsetHeight: height } = note;
    const below = bottom + 6 + height <= innerHeight;
    note.style.left = `${Math.max(6, Math.min(left, document.documentElement.clientWidth - width - 6))}px`;
    note.style.top = `${below ? bottom + 6 : Math.max(6, top - height - 6)}px`;
}

// A tap moves no pointer over a symbol for long: it gives it the focus.
addEventListener("pointerover", (event) => event.pointerType === "mouse" && show(of(event) ?? focused()));
addEventListener("focusin", (event) => show(of(event)));
addEventListener("focusout", () => show(null));
addEventListener("scroll", () => at && show(at), { capture: true, passive: true });
addEventListener("keydown", (event) => event.key === "Escape" && show(null));
// A symbol within a label explains itself instead of leading to the control.
addEventListener("click", (event) => {
    const element = of(event);
    if (!element) return;
    event.preventDefault();
    element.focus();
    show(element);
});

const focused = () => document.activeElement?.closest("[data-help]") ?? null;
