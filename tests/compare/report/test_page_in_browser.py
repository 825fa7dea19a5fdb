from contextlib import contextmanager

import pytest
from playwright.sync_api import sync_playwright


@pytest.fixture(scope="module")
def browser(browser_path):
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_path)
        yield browser
        browser.close()


WIDTHS = 1280, 390


@contextmanager
def page_at(browser, reported, where="", **options):
    """Yield the page, with the addresses that it requested; ``where`` is the end of its link."""
    page = browser.new_page(**options)
    asked = []
    page.on("request", lambda sent: asked.append(sent.url))
    page.goto((reported[1] / "index.html").as_uri() + where, wait_until="load")
    yield page, asked
    page.close()


@pytest.fixture(params=WIDTHS)
def opened(request, browser, reported):
    """The page, and the addresses that it requested."""
    with page_at(browser, reported, viewport={"width": request.param, "height": 800}) as opened:
        yield opened


@pytest.fixture
def page(browser, reported):
    """The page at one width, to test behaviour that is the same at every width."""
    with page_at(browser, reported) as (page, _):
        yield page


def overhang(page):
    return page.evaluate("document.documentElement.scrollWidth - window.innerWidth")


TABLES_OUTSIDE = """[...document.querySelectorAll('table')].filter(table =>
    table.getBoundingClientRect().right > innerWidth && !table.closest('.scroll')).length"""
SMALLEST = """Math.min(...[...document.querySelectorAll('main *')].filter(e => e.innerText)
    .map(e => parseFloat(getComputedStyle(e).fontSize)))"""
NAMED = """[...document.querySelectorAll('table')].every(table => table.caption)
    && [...document.querySelectorAll('section, nav, input, select')].every(it => it.ariaLabel
        || document.getElementById(it.getAttribute('aria-labelledby')))"""


WORDS = ("agrees", "differs", "inconclusive", "failed")


def test_the_verdicts_are_explained_above_the_first_table_by_keyboard_and_in_print(page):
    words = page.locator("details.words")
    assert page.evaluate(
        "document.querySelector('.words').compareDocumentPosition(document.querySelector('table')) & 4"
    )
    page.evaluate("document.querySelector('.words summary').focus()")
    for shown in (False, True):
        assert words.locator("dl").first.is_visible() == shown
        page.keyboard.press("Enter")
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert words.locator("dl").first.is_visible()
    terms = " ".join(words.locator("dt").all_inner_texts())
    assert [word for word in (*WORDS, "rough", "not simulated", "missing") if word in terms] == [*WORDS]


def test_the_page_fits_is_legible_and_makes_no_requests(opened):
    page, asked = opened
    assert overhang(page) <= 0
    assert page.evaluate(TABLES_OUTSIDE) == 0  # or inside a scrolling container
    assert page.evaluate(SMALLEST) >= 11
    assert page.evaluate(NAMED)
    assert asked
    assert all(url.startswith(("file:", "data:")) for url in asked)


def test_the_first_screen_shows_totals_differences_and_grades(opened):
    page, _ = opened
    page.evaluate("scrollTo(0, document.getElementById('glance').offsetTop)")  # below the contents on a phone
    top = page.locator("#glance").bounding_box()["y"]
    table = page.locator("#engines table").bounding_box()
    assert page.locator("#totals").bounding_box()["y"] < table["y"] < top + 500
    assert page.locator(".exceptions .verdict.differs").bounding_box()["y"] < table["y"]
    assert table["y"] + table["height"] < top + 800
    assert page.locator("#engines .badge").all_inner_texts()[:2] == ["differs", "differs"]


def test_all_images_are_decoded_when_visible(page):
    page.evaluate("location.hash = '#verdicts'")
    page.evaluate("[...document.images].forEach(image => { image.loading = 'eager'; })")
    page.wait_for_function("[...document.images].every(image => image.complete)")
    assert page.evaluate("[...document.images].map(image => image.naturalWidth > 0)") == [True, True]


CLAIM = "verdicts/the-equilibrium-is-lost-at-the-load-of-eq-5"


def test_a_link_opens_its_target(opened):
    page, _ = opened
    assert not page.locator("main details.claim[open]").count()  # few studies are open
    page.locator(".exceptions a").nth(1).click()
    assert page.evaluate("location.hash") == f"#{CLAIM}"
    table = page.locator(f'[data-claim="{CLAIM}"]')
    assert table.is_visible()
    assert -1 <= page.locator(f'[id="{CLAIM}"]').bounding_box()["y"] < 800
    page.goto(page.url.partition("#")[0] + "#figure/fake-radius")
    page.reload()
    assert page.locator('[id="figure/fake-radius"]').is_visible()


def test_the_link_of_an_engine_leads_to_its_claims(opened):
    page, _ = opened
    page.locator(".glance tbody a").first.click()
    page.wait_for_url("**?engine=good#studies")
    assert page.locator("#found").inner_text() == "5 of 6 claims"
    assert page.locator("#studies").bounding_box()["y"] < 800


def test_the_link_to_the_claims_opens_none(page):
    page.locator(".ways a", has_text="Check one claim").click()
    assert page.locator("main details.claim[open]").count() == 0


def test_the_page_is_readable_without_scripts(browser, reported):
    with page_at(browser, reported, f"#{CLAIM}", java_script_enabled=False) as (page, _):
        page.locator(f'[id="{CLAIM}"] > summary').click()  # the browser opens its study
        assert page.locator(f'[data-claim="{CLAIM}"]').is_visible()
        assert not page.locator("#find").is_visible()


def shown(page):
    """Return the claims that a filter shows."""
    return page.evaluate("[...document.querySelectorAll('details.claim:not([hidden])')].map(one => one.id)")


def test_filters_select_claims_and_are_stored_in_the_link(page):
    everything = shown(page)
    page.select_option("[name=verdict]", "differs")
    assert shown(page) == [CLAIM]
    assert page.locator("#found").inner_text() == f"1 of {len(everything)} claims"
    assert "verdict=differs" in page.url
    page.reload()
    assert shown(page) == [CLAIM]
    page.select_option("[name=engine]", "theory")
    assert shown(page) == []
    page.locator("[name=q]").press("Escape")
    assert shown(page) == everything
    assert "?" not in page.url


@pytest.mark.parametrize(
    "asked",
    [
        "q=semicircle",
        "q=release+eq.",
        "q=Semi-circle",
        "q=eq.+4",
        "q=eq.+8",
        "evidence=algebra",
        "equation=(4)",
        "study=agreement",
    ],
)
def test_a_link_may_contain_a_filter(browser, reported, asked):
    with page_at(browser, reported, f"?{asked}") as (page, _):
        assert len(shown(page)) == 1


def test_keys_move_to_the_search_and_between_claims(page):
    page.set_viewport_size({"width": 1280, "height": 300})
    page.keyboard.press("/")
    assert page.evaluate("document.activeElement.name") == "q"
    page.keyboard.type("semicircle")
    (found,) = page.locator("details.claim:not([hidden]) > summary").all()  # below the text of its study
    assert 0 <= found.bounding_box()["y"] < 200
    page.evaluate("document.activeElement.blur()")
    for _ in range(2):
        page.keyboard.press("j")
    page.keyboard.press("Enter")
    assert page.locator("details.claim[open]").count() == 1


def test_an_animation_plays_where_its_study_opens_and_pauses_on_request(page):
    page.evaluate("location.hash = '#figure/fake-motion'")
    image, button = page.locator(".moves img"), page.locator(".moves .play")
    for suffix, word in (
        (".gif", "Pause"),
        (".png", "Play"),
        (".gif", "Pause"),
    ):  # it plays once its study opens
        page.wait_for_function(
            "word => document.querySelector('.moves .play').textContent === word", arg=word
        )
        assert image.get_attribute("src").endswith(suffix)
        button.click()


def test_an_animation_stands_still_for_readers_who_prefer_it(browser, reported):
    with page_at(browser, reported, "#figure/fake-motion", reduced_motion="reduce") as (page, _):
        page.wait_for_timeout(100)
        assert page.locator(".moves img").get_attribute("src").endswith(".png")


CONTRASTS = """() => {
  const canvas = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
  const rgb = colour => {
    canvas.clearRect(0, 0, 1, 1); canvas.fillStyle = colour; canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data];
  };
  const light = ([r, g, b]) => [r, g, b].map(c => c / 255)
    .map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = element => {
    for (let it = element; it; it = it.parentElement) {
      const colour = rgb(getComputedStyle(it).backgroundColor);
      if (colour[3] === 255) return colour;
    }
    return [255, 255, 255, 255];
  };
  for (const one of document.querySelectorAll('details')) one.open = true;
  return [...document.querySelectorAll('body *')]
    .filter(e => [...e.childNodes].some(n => n.nodeType === 3 && n.data.trim()) && e.offsetParent)
    .map(e => {
      const [a, b] = [light(rgb(getComputedStyle(e).color)), light(behind(e))].sort((x, y) => y - x);
      return [(a + 0.05) / (b + 0.05), e.className, e.innerText.slice(0, 40)];
    }).sort((x, y) => x[0] - y[0])[0];
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_contrasts_with_its_background(browser, reported, scheme):
    with page_at(browser, reported, color_scheme=scheme) as (page, _):
        contrast, *where = page.evaluate(CONTRASTS)
        assert contrast >= 4.5, where
        dark = page.evaluate("getComputedStyle(document.body).backgroundColor") != "rgb(255, 255, 255)"
        assert dark == (scheme == "dark")


def test_the_print_fits_the_paper_and_leaves_the_tables_of_claims_to_the_screen(browser, reported):
    a4_without_margins = {"width": 688, "height": 1000}
    with page_at(browser, reported, viewport=a4_without_margins) as (page, _):
        page.emulate_media(media="print")
        assert overhang(page) <= 0
        page.evaluate("dispatchEvent(new Event('beforeprint'))")
        assert page.locator("#verdicts figure").first.is_visible()
        claims = page.locator("table.claims").all()
        assert claims
        assert not any(one.is_visible() for one in claims)
        assert not page.locator("#contents").is_visible()
        assert page.pdf(prefer_css_page_size=True).startswith(b"%PDF")
