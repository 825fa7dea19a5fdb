// Search, filters stored in the URL, keys, and animations that start on request. The page is readable without it.
(() => {
  "use strict";
  document.documentElement.classList.add("scripted");
  const form = document.getElementById("find");
  const found = document.getElementById("found");
  // "Eq. 16" finds "(16)"; hyphens, dashes, accents and the height of digits do not count.
  // Claims call a quasi-periodic motion modulated.
  const plain = (text) => text.normalize("NFKD").toLowerCase()
    .replace(/\b(?:eqs?|equations?)\.?\s*\(?(\d+)\)?/g, "eq. ($1)")
    .replace(/[\p{Pd}\u2212\u00ad\p{M}]/gu, "")
    .replace(/quasi ?periodic/g, "modulated");
  // A claim about "(19)–(21)" is also about (20).
  const listed = (equations) => equations.replace(/\((\d+)\)–\((\d+)\)/g, (range, first, last) =>
    Array.from({ length: last - first + 1 }, (_, index) => `(${Number(first) + index})`).join(" "));
  const recorded = [...document.querySelectorAll("tbody[data-engine]")];
  const claims = [...document.querySelectorAll("details.claim")].map((element) => ({
    element,
    study: element.closest("details.study"),
    text: plain(`${element.textContent} ${listed(element.dataset.equation)} ${element.id}`),
    equation: element.dataset.equation,
    cells: element.dataset.cells.split(";").map((cell) => cell.split("|")),
  }));
  const studies = [...document.querySelectorAll("details.study")].map((element) => ({
    element,
    opened: false,
    text: plain([...element.children].filter((child) => !child.matches("details"))
      .map((child) => child.textContent).join(" ")),
  }));
  const fields = [...form.elements].filter((field) => field.name);

  const narrow = matchMedia("screen and (max-width: 900px)").matches;
  document.querySelector(".toc").open = !narrow;

  function wanted() {
    return Object.fromEntries(fields.filter((field) => field.value).map((field) => [field.name, field.value]));
  }

  function shows(claim, asked, words) {
    if (asked.study && claim.study.id !== asked.study) return false;
    if (asked.equation && claim.equation !== asked.equation) return false;
    const cell = ([engine, verdict, evidence]) => (!asked.engine || engine === asked.engine)
      && (!asked.verdict || verdict === asked.verdict) && (!asked.evidence || evidence === asked.evidence);
    return claim.cells.some(cell) && words.every((word) => claim.text.includes(word));
  }

  function filter() {
    const asked = wanted();
    const words = plain(asked.q || "").replaceAll("eq. (", "(").split(/\s+/).filter(Boolean);
    const active = Object.keys(asked).length > 0;
    const onlyWords = words.length > 0 && Object.keys(asked).length === 1;
    const within = new Map();
    let count = 0;
    for (const claim of claims) {
      const shown = shows(claim, asked, words);
      claim.element.hidden = !shown;
      count += shown;
      within.set(claim.study, (within.get(claim.study) || 0) + shown);
    }
    for (const study of studies) {
      const told = onlyWords && words.every((word) => study.text.includes(word));
      study.element.hidden = active && !within.get(study.element) && !told;
      if (active && within.get(study.element) && count <= 120 && !study.element.open) {
        study.element.open = study.opened = true;
      } else if (!active && study.opened) {
        study.element.open = study.opened = false;
      }
    }
    const settings = recorded.filter((one) => one.dataset.engine === asked.engine);
    for (const one of recorded) one.hidden = settings.length > 0 && !settings.includes(one);
    for (const one of settings) one.closest("details").open = true;
    const tables = settings.length ? ", and recorded motions" : "";
    found.textContent = active ? `${count} of ${claims.length} claims${tables}` : "";
    for (const heading of document.querySelectorAll("h3.section")) {
      let next = heading.nextElementSibling;
      let any = false;
      for (; next && next.matches("details.study"); next = next.nextElementSibling) any = any || !next.hidden;
      heading.hidden = !any;
    }
    return asked;
  }

  function remember() {
    const state = new URLSearchParams(filter()).toString();
    try {
      history.replaceState(null, "", location.pathname + (state ? `?${state}` : "") + location.hash);
    } catch {
      // some browsers do not allow this for local files
    }
    show();
  }

  function show() {
    const shown = claims.filter((it) => !it.element.hidden);
    const first = shown.find((it) => it.study.open);
    const settings = shown.length ? null : recorded.find((it) => it.dataset.engine === wanted().engine);
    const place = settings || (first ? first.element : document.getElementById("studies"));
    if (!narrow && Object.keys(wanted()).length) place.scrollIntoView();
  }

  function reveal() {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    if (target === form) return void form.elements.q.focus();
    for (let it = target; it; it = it.parentElement) {
      it.hidden = false;
      if (it.matches("details")) it.open = true;
    }
    const own = target.matches("section") ? target.querySelectorAll(":scope > details") : [];
    if (own.length === 1) own[0].open = true;
    target.scrollIntoView();
  }

  function step(by) {
    const shown = [...document.querySelectorAll("details.study > summary, details.study[open] > details.claim > summary")]
      .filter((one) => one.offsetParent !== null);
    const at = shown.indexOf(document.activeElement);
    const next = shown[Math.min(Math.max(at + by, 0), shown.length - 1)];
    if (next) next.focus();
  }

  for (const [name, value] of new URLSearchParams(location.search)) {
    if (form.elements[name]) form.elements[name].value = value;
  }
  form.addEventListener("input", remember);
  form.addEventListener("submit", (event) => event.preventDefault());
  addEventListener("hashchange", reveal);
  addEventListener("keydown", (event) => {
    const typing = event.target.matches("input, select");
    if (event.key === "Escape" && wanted() && typing) {
      form.reset();
      remember();
    } else if (typing || event.ctrlKey || event.metaKey || event.altKey) {
      return;
    } else if (event.key === "/") {
      event.preventDefault();
      form.elements.q.focus();
    } else if (event.key === "j" || event.key === "k") {
      step(event.key === "j" ? 1 : -1);
    }
  });
  for (const link of document.querySelectorAll("a.play")) {
    const image = link.closest("figure").querySelector("img");
    const still = image.getAttribute("src");
    const play = (moves) => {
      image.src = moves ? link.getAttribute("href") : still;
      link.textContent = moves ? "Pause" : "Play";
    };
    link.setAttribute("role", "button");
    link.addEventListener("click", (event) => {
      event.preventDefault();
      play(image.getAttribute("src") === still);
    });
    const study = link.closest("details.study");
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    study.addEventListener("toggle", () => play(study.open && !calm && !matchMedia("print").matches));
  }
  let closed = [];
  addEventListener("beforeprint", () => {
    closed = [...document.querySelectorAll("details:not([open]):not(.claim)")];
    for (const one of closed) one.open = true;
    for (const image of document.images) image.loading = "eager";
  });
  addEventListener("afterprint", () => closed.forEach((one) => { one.open = false; }));
  filter();
  if (location.hash) reveal();
  else show();
})();
