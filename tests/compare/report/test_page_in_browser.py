import pytest
from playwright.sync_api import sync_playwright


@pytest.fixture(scope="module")
def browser(browser_path):
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_path)
        yield browser
        browser.close()


@pytest.fixture(params=[1280, 400])
def opened(request, browser, reported):
    """The page at a width, with the addresses that it asked for."""
    page = browser.new_page(viewport={"width": request.param, "height": 800})
    asked = []
    page.on("request", lambda sent: asked.append(sent.url))
    page.goto((reported[1] / "index.html").as_uri(), wait_until="load")
    yield page, asked
    page.close()


def overhang(page):
    """How far the page is wider than the window."""
    return page.evaluate("document.documentElement.scrollWidth - window.innerWidth")


def test_the_page_does_not_scroll_sideways(opened):
    assert overhang(opened[0]) <= 0


def test_tables_stay_inside_of_the_page_or_scroll_in_their_own_container(opened):
    outside = opened[0].evaluate(
        """() => [...document.querySelectorAll('table')].filter(table =>
               table.getBoundingClientRect().right > innerWidth && !table.closest('.scroll')).length"""
    )
    assert outside == 0


def test_the_first_screen_shows_totals_what_differs_and_the_studies(opened):
    box = opened[0].locator("#overview table").bounding_box()
    assert 0 <= box["y"] < 400
    assert opened[0].locator("#totals").bounding_box()["y"] < box["y"]
    assert opened[0].locator(".exceptions .verdict.differs").bounding_box()["y"] < box["y"]
    assert opened[0].locator("#overview .tally.short").last.bounding_box()["y"] < 800


def test_a_claim_has_most_of_the_width_of_the_matrix_however_long_the_units(opened):
    opened[0].evaluate(
        """() => document.querySelectorAll('#matrix td[data-label]').forEach(
               cell => cell.textContent = '± 1.2×10⁻⁹ m, rad, m/s, rad/s, or about as much')"""
    )
    assert overhang(opened[0]) <= 0
    if opened[0].viewport_size["width"] > 720:  # stacked on a telephone
        claim, engine = (
            opened[0].locator(f"#matrix thead th:nth-child({i})").bounding_box()["width"] for i in (1, 3)
        )
        assert claim > 2.5 * engine


def test_all_images_are_decoded(opened):
    sizes = opened[0].evaluate("[...document.images].map(image => [image.complete, image.naturalWidth])")
    assert len(sizes) == 2
    assert all(complete and width > 0 for complete, width in sizes)


def test_nothing_is_asked_of_the_network(opened):
    assert opened[1]
    assert all(url.startswith(("file:", "data:")) for url in opened[1])


def test_text_is_large_enough_to_read(opened):
    smallest = opened[0].evaluate(
        """() => Math.min(...[...document.querySelectorAll('main *')].filter(e => e.innerText)
               .map(e => parseFloat(getComputedStyle(e).fontSize)))"""
    )
    assert smallest >= 11


def test_links_of_the_overview_lead_to_the_studies(opened):
    opened[0].locator("#overview tbody a").first.click()
    assert opened[0].evaluate("location.hash") == "#verdicts"
    assert -1 <= opened[0].locator("#verdicts").bounding_box()["y"] < 800


def test_links_of_the_matrix_lead_to_the_claims(opened):
    page = opened[0]
    page.locator("#matrix tbody tr:not(.study) th a").nth(3).click()
    assert page.evaluate("location.hash") == "#verdicts-4"
    assert -1 <= page.locator("#verdicts-4").bounding_box()["y"] < 800


def test_the_print_fits_on_its_paper(browser, reported):
    page = browser.new_page(viewport={"width": 688, "height": 1000})  # A4 within its margins
    page.goto((reported[1] / "index.html").as_uri())
    page.emulate_media(media="print")
    assert overhang(page) <= 0
    assert page.locator("#matrix table").is_visible()
    assert page.pdf(prefer_css_page_size=True).startswith(b"%PDF")
    page.close()
