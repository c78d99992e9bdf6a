// SPDX-License-Identifier: Apache-2.0
// --display-server: the bytes of tev's protocol, and what a viewer gets that is quick, slow or gone.
#include "view/tev_viewer.h"

#include "error.h"
#include "view/tev_packets.h"

#include <arpa/inet.h>
#include <cstring>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace clrt {

namespace {

/// A snapshot whose values tell their place.
SnapshotPointer test_snapshot(int width, int height, bool has_errors, float first = 0) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->width = width;
    snapshot->height = height;
    for (int i = 0; i < 3 * width * height; ++i)
        snapshot->rgb.push_back(first + float(i));
    for (int i = 0; has_errors && i < width * height; ++i)
        snapshot->errors.push_back(-first - float(i));
    return snapshot;
}

/// Listens on a port of this machine as tev does.
class Receiver {
public:
    Receiver() : listener_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
        EXPECT_EQ(listen(listener_, 1), 0);
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
    }
    ~Receiver() { hang_up(); }

    DisplayServer address() const { return {"127.0.0.1", port_}; }
    void answer() { connection_ = accept(listener_, nullptr, nullptr); }
    void hang_up() {
        for (int* descriptor : {&connection_, &listener_})
            if (*descriptor >= 0)
                close(std::exchange(*descriptor, -1));
    }
    /// The next packet, its length included.
    std::string packet() {
        std::uint32_t length = 0;
        EXPECT_EQ(recv(connection_, &length, sizeof length, MSG_WAITALL), ssize_t(sizeof length));
        std::string bytes(length, '\0');
        std::memcpy(bytes.data(), &length, sizeof length);
        EXPECT_EQ(recv(connection_, &bytes[4], length - 4, MSG_WAITALL), ssize_t(length - 4));
        return bytes;
    }

private:
    int listener_, connection_ = -1, port_ = 0;
};

TevPatience short_patience() {
    using std::chrono::milliseconds;
    return {milliseconds(500), milliseconds(150), milliseconds(300)};
}

/// Waits until it holds, twenty seconds at most.
template <class Condition>
bool comes_true(Condition&& condition) {
    for (int i = 0; i < 2000 && !condition(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
}

} // namespace

TEST(TevPackets, AnImageIsMadeByItsNameSizeAndChannels) {
    const std::string expected("\x1b\0\0\0\4\1box\0\x20\3\0\0\x58\2\0\0\2\0\0\0R\0GB\0", 27);
    EXPECT_EQ(tev_create({"box", 800, 600, {"R", "GB"}}), expected);
}

TEST(TevPackets, AnUpdateHasItsRowsWithOffsetsAndStrides) {
    std::string expected("\0\0\0\0\6\0b\0\2\0\0\0R\0Y\0\0\0\0\0\3\0\0\0\1\0\0\0\2\0\0\0", 32);
    expected += std::string("\0\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0", 32);
    expected += std::string("\0\0\x80\x3f\0\0\0\xc0\0\0\x40\x40\0\0\0\0", 16); // 1, -2, 3, 0
    expected[0] = char(expected.size());
    EXPECT_EQ(tev_update({"b", 1, 9, {"R", "Y"}}, 3, 2, {1, -2, 3, 0}), expected);
}

TEST(TevViewer, APictureComesWithItsErrorAndIsMadeOnce) {
    Receiver tev;
    TevViewer viewer(tev.address());
    tev.answer();
    const TevImage image{"a", 2, 3, {"R", "G", "B", "error.Y"}};
    for (const float first : {0.0f, 100.0f}) {
        EXPECT_TRUE(viewer.is_free());
        viewer.show(test_snapshot(2, 3, true, first), "a");
        viewer.finish();
        if (first == 0)
            EXPECT_EQ(tev.packet(), tev_create(image));
        std::vector<float> values;
        for (int pixel = 0; pixel < 6; ++pixel)
            for (const float value : {first + float(3 * pixel), first + float(3 * pixel + 1),
                                      first + float(3 * pixel + 2), -first - float(pixel)})
                values.push_back(value);
        EXPECT_EQ(tev.packet(), tev_update(image, 0, 3, values));
    }
    viewer.show(test_snapshot(2, 3, false), "b");
    EXPECT_EQ(tev.packet(), tev_create({"b", 2, 3, {"R", "G", "B"}})) << "another name, no error";
    EXPECT_EQ(viewer.loss(), "");
}

TEST(TevViewer, LargePicturesComeInPacketsOfTheirRows) {
    Receiver tev;
    TevViewer viewer(tev.address());
    tev.answer();
    viewer.show(test_snapshot(2000, 700, false), "large");
    tev.packet();
    const TevImage image{"large", 2000, 700, {"R", "G", "B"}};
    std::string all;
    for (int y = 0, rows = 349; y < 700; y += rows) {
        const std::string packet = tev.packet(), head = tev_update(image, y, std::min(rows, 700 - y), {});
        ASSERT_EQ(packet.substr(4, head.size() - 4), head.substr(4)) << "row " << y;
        all += packet.substr(head.size());
    }
    EXPECT_EQ(all.size(), 4u * 3 * 2000 * 700);
    const float last = float(3 * 2000 * 700 - 1);
    EXPECT_EQ(std::memcmp(&all[all.size() - 4], &last, 4), 0);
}

TEST(TevViewer, OneThatIsGoneIsNoticed) {
    Receiver tev;
    TevViewer viewer(tev.address());
    tev.answer();
    tev.hang_up();
    EXPECT_TRUE(comes_true([&] {
        if (viewer.is_free())
            viewer.show(test_snapshot(64, 64, true), "a");
        return !viewer.loss().empty();
    }));
    EXPECT_EQ(viewer.loss(), "it has closed the connection");
    EXPECT_FALSE(viewer.is_free());
    viewer.finish(); // waits for nothing
}

TEST(TevViewer, OneThatTakesNothingIsLeft) {
    Receiver tev;
    TevViewer viewer(tev.address(), short_patience());
    tev.answer();
    viewer.show(test_snapshot(2000, 700, false), "large"); // more than the system keeps
    EXPECT_FALSE(viewer.is_free()) << "others are not taken meanwhile";
    EXPECT_TRUE(comes_true([&] { return !viewer.loss().empty(); }));
    EXPECT_EQ(viewer.loss(), "it takes no data any more");
}

TEST(TevViewer, TheEndDoesNotWaitForASlowOne) {
    Receiver tev;
    TevPatience patience = short_patience();
    patience.still = std::chrono::seconds(60);
    TevViewer viewer(tev.address(), patience);
    tev.answer();
    viewer.show(test_snapshot(2000, 700, false), "large");
    viewer.finish();
    EXPECT_EQ(viewer.loss(), "it has not taken the finished picture in time");
}

TEST(TevViewer, WhereNobodyListensIsSaid) {
    Receiver tev;
    const DisplayServer address = tev.address();
    tev.hang_up();
    for (const DisplayServer& server : {address, DisplayServer{"no..name", 14158}})
        try {
            const TevViewer viewer(server);
            FAIL() << server.host;
        } catch (const UsageError& error) {
            EXPECT_EQ(std::string(error.what())
                          .find("option --display-server: expected tev to listen on port " +
                                std::to_string(server.port) + " of '" + server.host + "'"),
                      0u)
                << error.what();
        }
}

} // namespace clrt
